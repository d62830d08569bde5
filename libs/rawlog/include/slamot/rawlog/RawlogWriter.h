#pragma once
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <memory>
#include <string>

namespace slamot {

/// Writes a gz-compressed log as FILE.part; `close` renames it and writes FILE.sha256 beside it (the format
/// of sha256sum). A log is of observations or of frames, never both.
class RawlogWriter {
  public:
    /// Throws LogError when the file cannot be written.
    explicit RawlogWriter(const std::string& file);
    /// Without `close`, the .part file stays.
    ~RawlogWriter();

    void write(const mrpt::obs::CObservation& observation);
    void writeFrame(const mrpt::obs::CActionCollection& action, const mrpt::obs::CSensoryFrame& observations);
    /// A movement after the last frame, as MRPT's own logs end.
    void writeAction(const mrpt::obs::CActionCollection& action);
    void close();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// SHA-256 of a file, in hex.
std::string sha256OfFile(const std::string& file);

enum class Checksum { none, matches, differs };
/// Compares FILE with FILE.sha256.
Checksum checkChecksum(const std::string& file);

}  // namespace slamot

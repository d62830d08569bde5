#pragma once
#include <mrpt/obs/CObservation.h>

#include <memory>
#include <string>

namespace slamot {

/// Writes an observations-only log, gz-compressed, as FILE.part; `close` renames it and writes FILE.sha256 beside
/// it (the format of sha256sum).
class RawlogWriter {
   public:
    /// Throws LogError when the file cannot be written.
    explicit RawlogWriter(const std::string& file);
    /// Without `close`, the .part file stays.
    ~RawlogWriter();

    void write(const mrpt::obs::CObservation& observation);
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

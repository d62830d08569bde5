#pragma once
// Streams either of MRPT's log formats in a stable order.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/LogSource.h"

namespace slamot {

/// Step 0 of action-frame logs without usable stamps: 2020-01-01 00:00 UTC.
inline constexpr Stamp action_frame_epoch{1'577'836'800 * Stamp::ticks_per_second};

/// Section `[log]`: how a log is read.
struct LogParameters {
    double reorder_window = 1.0;  ///< [s]
    double step = 0.1;            ///< [s] per frame, for action-frame logs without usable stamps
};
ParameterTable describe(LogParameters& parameters);

enum class LogFormat { observations, action_frames };

/// Action-frame logs are ordered by position; their time is the step number times `step` where the stamps
/// cannot be used.
class RawlogReader : public LogSource {
  public:
    /// Throws LogError when the file is missing, empty or no rawlog.
    RawlogReader(const std::string& file, const LogParameters& parameters);
    ~RawlogReader() override;

    /// Throws LogError for an action whose numbers are not finite: the way would be lost.
    std::optional<LogEntry> next() override;

    LogFormat format() const;
    /// Action-frame logs only: their stamps cannot be used, the step number is their time.
    bool timedByStep() const;
    LogEnd end() const override;
    const std::string& endMessage() const override;
    /// Objects read from the file so far.
    std::int64_t objects() const;
    const DropTable& drops() const override;
    double progress() const override;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace slamot

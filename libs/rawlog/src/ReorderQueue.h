#pragma once
// Puts the observations of a log in their stable order within a window of time.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "slamot/rawlog/RawlogReader.h"

namespace slamot {

/// Odometry < lidar < detections < other: at one stamp the robot moves, then looks, then reports.
int orderRank(const mrpt::obs::CObservation& observation);

class ReorderQueue {
   public:
    /// `window` in seconds.
    explicit ReorderQueue(double window) : window_(Stamp::fromSeconds(window).ticks) {}

    /// False, and nothing taken, when the entry lies more than the window behind the newest stamp seen.
    bool push(LogEntry entry);
    /// The first entry in order, if no later arrival may come before it (or `flush`: whatever may come).
    std::optional<LogEntry> pop(bool flush);

   private:
    using Key = std::tuple<std::int64_t, int, std::string, std::int64_t>;  // stamp, rank, label, position

    std::int64_t window_;
    std::optional<std::int64_t> newest_;
    std::map<Key, LogEntry> waiting_;
};

}  // namespace slamot

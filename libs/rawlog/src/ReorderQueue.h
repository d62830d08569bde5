#pragma once
// Puts the observations of a log in their stable order within a window of time.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "slamot/rawlog/LogSource.h"

namespace slamot {

/// Odometry < lidar < detections < other: at one stamp the robot moves, then looks, then reports.
int orderRank(const mrpt::obs::CObservation& observation);

class ReorderQueue {
  public:
    /// `window` in seconds.
    explicit ReorderQueue(double window) : window_(Stamp::fromSeconds(window).ticks) {}

    struct Dropped {
        std::string label;
        const char* reason;
    };

    /// Takes an entry and says what was dropped for it. `late`: an entry more than the window behind the
    /// newest stamp. An entry more than `jump` ahead of the newest, or the first of all, is set aside until
    /// the next one comes: `stamp-jump` if that one goes back, for else a single wild stamp would make all
    /// after it late.
    std::vector<Dropped> push(LogEntry entry);
    /// The first entry in order, if no later arrival may come before it (or `flush`: whatever may come).
    std::optional<LogEntry> pop(bool flush);

  private:
    using Key = std::tuple<std::int64_t, int, std::string, std::int64_t>;  // stamp, rank, label, position

    void add(LogEntry entry, std::vector<Dropped>& dropped);

    // Pauses within a log are shorter, or both sides of them agree.
    static constexpr std::int64_t jump = Stamp::ticks_per_second * 3600;

    std::int64_t window_;
    std::optional<LogEntry> ahead_;  ///< set aside
    std::optional<std::int64_t> newest_;
    std::map<Key, LogEntry> waiting_;
};

/// The queue of a whole log: takes observations as they come and counts what it drops.
class ObservationQueue {
  public:
    ObservationQueue(double window, DropTable& drops) : queue_(window), drops_(drops) {}
    void push(mrpt::obs::CObservation::Ptr observation, std::int64_t position);
    std::optional<LogEntry> pop(bool flush) { return queue_.pop(flush); }

  private:
    ReorderQueue queue_;
    DropTable& drops_;
};

}  // namespace slamot

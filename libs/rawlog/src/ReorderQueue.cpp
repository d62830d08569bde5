#include "ReorderQueue.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>

#include "ActionFrames.h"

namespace slamot {

int orderRank(const mrpt::obs::CObservation& observation) {
    using namespace mrpt::obs;
    if (IS_CLASS(observation, CObservationOdometry)) return 0;
    if (IS_CLASS(observation, CObservation2DRangeScan) || IS_CLASS(observation, CObservationPointCloud) ||
        IS_CLASS(observation, CObservation3DRangeScan) || IS_CLASS(observation, CObservationVelodyneScan) ||
        IS_CLASS(observation, CObservationRotatingScan))
        return 1;
    if (IS_CLASS(observation, CObservationBearingRange)) return 2;
    return 3;
}

std::vector<ReorderQueue::Dropped> ReorderQueue::push(LogEntry entry) {
    std::vector<Dropped> dropped;
    const std::int64_t t = entry.stamp.ticks;
    if (ahead_) {
        // After a jump what comes next must not be late behind it. The log's first entry has nothing before
        // it that speaks against it, so only a jump back does.
        const bool goes_back = ahead_->stamp.ticks - t > (newest_ ? window_ : jump);
        if (goes_back)
            dropped.push_back({ahead_->observation->sensorLabel, "stamp-jump"});
        else
            add(std::move(*ahead_), dropped);
        ahead_.reset();
    }
    if (!newest_ || t - *newest_ > jump)
        ahead_ = std::move(entry);
    else
        add(std::move(entry), dropped);
    return dropped;
}

void ReorderQueue::add(LogEntry entry, std::vector<Dropped>& dropped) {
    const std::int64_t t = entry.stamp.ticks;
    newest_ = std::max(newest_.value_or(t), t);
    if (*newest_ - t > window_) {
        dropped.push_back({entry.observation->sensorLabel, "late"});
        return;
    }
    Key key{t, orderRank(*entry.observation), entry.observation->sensorLabel, entry.position};
    waiting_.emplace(std::move(key), std::move(entry));
}

std::optional<LogEntry> ReorderQueue::pop(bool flush) {
    if (flush && ahead_) {
        // Nothing came after it that could speak against it. It is the newest, so it cannot be late.
        std::vector<Dropped> none;
        add(std::move(*ahead_), none);
        ahead_.reset();
    }
    if (waiting_.empty()) return std::nullopt;
    const auto first = waiting_.begin();
    // What still may come is no older than newest - window, so only what is older than that is settled.
    if (!flush && *newest_ - std::get<0>(first->first) <= window_) return std::nullopt;
    std::optional<LogEntry> entry = std::move(first->second);
    waiting_.erase(first);
    return entry;
}

void ObservationQueue::push(mrpt::obs::CObservation::Ptr observation, std::int64_t position) {
    const auto stamp = usableStamp(observation->timestamp);
    if (!stamp) {
        drops_.add(observation->sensorLabel, "no-stamp");
        return;
    }
    for (const auto& [sensor, reason] : queue_.push({*stamp, std::move(observation), std::nullopt, position}))
        drops_.add(sensor, reason);
}

}  // namespace slamot

#include "ReorderQueue.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>

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

bool ReorderQueue::push(LogEntry entry) {
    const std::int64_t t = entry.stamp.ticks;
    newest_ = std::max(newest_.value_or(t), t);
    if (*newest_ - t > window_) return false;
    Key key{t, orderRank(*entry.observation), entry.observation->sensorLabel, entry.position};
    waiting_.emplace(std::move(key), std::move(entry));
    return true;
}

std::optional<LogEntry> ReorderQueue::pop(bool flush) {
    if (waiting_.empty()) return std::nullopt;
    const auto first = waiting_.begin();
    // What still may come is no older than newest - window, so only what is older than that is settled.
    if (!flush && *newest_ - std::get<0>(first->first) <= window_) return std::nullopt;
    std::optional<LogEntry> entry = std::move(first->second);
    waiting_.erase(first);
    return entry;
}

}  // namespace slamot

#include "slamot/run/RecordSinks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace slamot::run {

void RunRecorder::step(const Step& step) {
    for (const Innovation& innovation : step.report.innovations) {
        const RangeBearingSet& set = step.detections.rangeBearing();
        const auto index = static_cast<std::size_t>(innovation.detection);
        record_.innovations.push_back({step.estimate.stamp, set.sensors[set.detections[index].sensor].label,
                                       innovation,
                                       eval::LogNumber{step.log_numbers.at(index), step.log_count}});
    }
    if (!clock_.due(step)) return;
    record_.trajectory.push_back({step.estimate.stamp, step.estimate.robot});
    if (!step.estimate.tracks.empty()) record_.tracks[step.estimate.stamp] = step.estimate.tracks;
}

void EstimateHash::step(const Step& step) {
    addInteger(step.estimate.stamp.ticks);
    addNumbers(step.estimate.robot.mean.vector().data(), 3);
    addNumbers(step.estimate.robot.covariance.data(), 9);
    for (const TrackEstimate& track : step.estimate.tracks) {
        addInteger(track.id.value);
        addNumbers(track.mean.data(), 6);
        addNumbers(track.covariance.data(), 36);
        addNumbers(&track.existence, 1);
        addNumbers(&track.moving, 1);
        addNumbers(track.mode_probabilities.data(), track.mode_probabilities.size());
    }
}

void EstimateHash::end(const RunEnd& end) {
    for (const LandmarkEstimate& landmark : end.landmarks) {
        addInteger(landmark.id.value);
        addNumbers(landmark.mean.data(), 2);
        addNumbers(landmark.covariance.data(), 4);
        addNumbers(&landmark.existence, 1);
        addNumbers(&landmark.moving, 1);
    }
    hex_ = sum_.hex();
}

void StepTimer::step(const Step& step) {
    pending_ += step.times.predict + step.times.detect + step.times.update;
    if (!step.has_detections) return;
    seconds_.push_back(pending_);
    pending_ = 0;
}

double StepTimer::mean() const {
    return std::accumulate(seconds_.begin(), seconds_.end(), 0.0) / static_cast<double>(seconds_.size());
}

double StepTimer::percentile(double q) const {
    if (seconds_.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sorted = seconds_;
    const auto index = static_cast<std::ptrdiff_t>(std::ceil(q * static_cast<double>(sorted.size())) - 1);
    const auto at = sorted.begin() + std::max<std::ptrdiff_t>(index, 0);
    std::nth_element(sorted.begin(), at, sorted.end());
    return *at;
}

void SensorRecord::step(const Step& step) {
    if (!step.has_detections) return;
    for (const RangeBearingSensor& sensor : step.detections.rangeBearing().sensors) sensors_[sensor.label] = sensor;
}

}  // namespace slamot::run

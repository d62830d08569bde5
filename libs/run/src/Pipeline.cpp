#include "slamot/run/Pipeline.h"

#include <fmt/format.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "slamot/rawlog/LogError.h"
#include "slamot/run/CpuClock.h"

namespace slamot::run {
namespace {

/// How long detections wait for odometry [s], unless max_odometry_gap is longer: more than any stall that a
/// robot drives through, little enough to hold.
constexpr double longest_wait = 30.0;

/// CPU time [s] of this thread or, so that what an estimator's threads use counts too, of the whole process.
double cpuSeconds(bool whole_process) {
    return whole_process ? processCpuSeconds() : threadCpuSeconds();
}

/// Adds the wall and CPU time of its life to a stage.
class StageClock {
  public:
    StageClock(double& wall, double& cpu, int threads)
        : wall_(wall),
          cpu_(cpu),
          whole_process_(threads > 1),
          wall_begin_(std::chrono::steady_clock::now()),
          cpu_begin_(cpuSeconds(whole_process_)) {}
    ~StageClock() {
        cpu_ += cpuSeconds(whole_process_) - cpu_begin_;
        wall_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_begin_).count();
    }

  private:
    double &wall_, &cpu_;
    bool whole_process_;
    std::chrono::steady_clock::time_point wall_begin_;
    double cpu_begin_;
};

bool isScan(const mrpt::obs::CObservation& observation) {
    return dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation) ||
           dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(&observation) ||
           dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation);
}

void appendSet(const RangeBearingSet& detected, RangeBearingSet& set) {
    const int offset = static_cast<int>(set.sensors.size());
    set.sensors.insert(set.sensors.end(), detected.sensors.begin(), detected.sensors.end());
    for (RangeBearingDetection detection : detected.detections) {
        detection.sensor += offset;
        set.detections.push_back(detection);
    }
}

}  // namespace

const char* toText(RunStatus status) {
    switch (status) {
        case RunStatus::complete:
            return "complete";
        case RunStatus::stopped:
            return "stopped";
        case RunStatus::truncated:
            return "truncated";
        case RunStatus::corrupt:
            return "corrupt";
        case RunStatus::failed:
            return "failed";
    }
    return "failed";
}

Pipeline::Pipeline(const RunConfig& config, Estimator& estimator, Detector* detector, const Truth* truth,
                   int threads, std::vector<Sink*> sinks)
    : config_(config),
      estimator_(estimator),
      detector_(detector),
      truth_(truth),
      threads_(threads),
      sinks_(std::move(sinks)),
      builder_(config, drops_, counts_.clutter) {}

void Pipeline::push(const LogEntry& entry) {
    if (entry.increment) {
        pushIncrement(*entry.increment);
        return;
    }
    const mrpt::obs::CObservation& observation = *entry.observation;
    labels_.insert(observation.sensorLabel);
    for (Sink* sink : sinks_) sink->observation(observation);

    if (const auto* odometry = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation)) {
        if (const auto reading = usable(*odometry)) pushOdometry(*reading, odometry->sensorLabel);
    } else if (const auto* seen = dynamic_cast<const mrpt::obs::CObservationBearingRange*>(&observation)) {
        pushDetections(*seen, entry.stamp);
    } else if (isScan(observation)) {
        pushScan(entry.observation, entry.stamp);
    } else {
        drops_.add(observation.sensorLabel,
                   std::string("unused-class-") + observation.GetRuntimeClass()->className);
    }
}

template <class Observation>
auto Pipeline::usable(const Observation& observation) -> std::optional<decltype(fromMrpt(observation))> {
    try {
        return fromMrpt(observation);
    } catch (const LogError& error) {
        drops_.add(observation.sensorLabel, "unusable");
        if (first_unusable_.empty()) first_unusable_ = error.what();
        return std::nullopt;
    }
}

void Pipeline::pushIncrement(const OdometryIncrement& odometry) {
    if (!started_) start(odometry.t0);
    ++counts_.odometry;
    if (odometry.t0 > estimator_.time()) {
        // Frames without a movement: MRPT's own programs take that as standing still, and so does this one.
        OdometryIncrement still;
        still.t0 = estimator_.time();
        still.t1 = odometry.t0;
        if (odometry.velocity) still.velocity = BodyVelocity{};
        if (odometry.covariance) still.covariance = Matrix3::Zero();
        still.entry_seconds = still.seconds();
        ++counts_.odometry_gaps;
        advance(still);
    }
    advance(odometry);
}

void Pipeline::pushScan(const mrpt::obs::CObservation::Ptr& scan, Stamp stamp) {
    ++counts_.scans;
    // Only what the config says: what a label means by itself is about range-bearing sensors.
    const auto said = config_.sensors.by_label.find(scan->sensorLabel);
    const SensorRole role = said == config_.sensors.by_label.end() ? SensorRole::lidar : said->second;
    const char* reason = role == SensorRole::ignore  ? "role-ignore"
                         : role != SensorRole::lidar ? "role-is-not-lidar"
                         : !detector_                ? "no-detector"
                                                     : nullptr;
    if (reason)
        drops_.add(scan->sensorLabel, reason);
    else if (Held* held = holdFor(stamp))
        held->scans.push_back(scan);
    else
        drops_.add(scan->sensorLabel, "after-odometry");
}

void Pipeline::pushOdometry(const OdometryReading& reading, const std::string& label) {
    if (config_.odometry != "auto" && label != config_.odometry) {
        drops_.add(label, "other-odometry");
        return;
    }
    if (!last_reading_)
        odometry_label_ = label;
    else if (label != odometry_label_)
        throw ConfigError(
            fmt::format("the log has odometry of several labels, '{}' and '{}': choose one with [run] "
                        "odometry",
                        odometry_label_, label));
    if (last_reading_ && reading.stamp <= last_reading_->stamp) {
        drops_.add(label, "same-stamp");
        return;
    }
    if (!started_) start(reading.stamp);
    ++counts_.odometry;
    if (last_reading_) {
        OdometryIncrement odometry;
        odometry.t0 = last_reading_->stamp;
        odometry.t1 = reading.stamp;
        odometry.increment = inverse(last_reading_->pose) * reading.pose;
        odometry.velocity = reading.velocity;
        odometry.entry_seconds = odometry.seconds();
        advance(odometry);
    }
    last_reading_ = reading;
}

void Pipeline::pushDetections(const mrpt::obs::CObservationBearingRange& seen, Stamp stamp) {
    // What is not used counts too: truth numbers all detections of the log.
    int& log_count = log_counts_[stamp];
    HeldReading held;
    held.observation = observations_++;
    held.first_number = log_count;
    log_count += static_cast<int>(seen.sensedData.size());

    const auto reading = usable(seen);
    if (!reading) return;
    held.reading = *reading;
    held.claim = Vector2(seen.sensor_std_range, seen.sensor_std_yaw).cwiseAbs2().asDiagonal();
    const auto role = config_.sensors.of(reading->sensor.label);
    if (!role || *role == SensorRole::ignore || *role == SensorRole::lidar)
        drops_.add(reading->sensor.label, role ? "role-ignore" : "no-role-in-[sensors]");
    else if (Held* waiting = holdFor(stamp))
        waiting->readings.push_back(std::move(held));
    else
        drops_.add(reading->sensor.label, "after-odometry");
}

Pipeline::Held* Pipeline::holdFor(Stamp stamp) {
    if (!started_)
        dropHeldBefore(stamp);  // the start comes no earlier than the newest entry
    else if (secondsBetween(estimator_.time(), stamp) > std::max(longest_wait, config_.max_odometry_gap))
        return nullptr;
    if (held_.empty() || held_.back().stamp != stamp) held_.push_back({stamp, {}, {}});
    return &held_.back();
}

void Pipeline::dropHeldBefore(Stamp stamp) {
    const auto kept =
        std::find_if(held_.begin(), held_.end(), [&](const Held& held) { return held.stamp >= stamp; });
    for (auto held = held_.begin(); held != kept; ++held) drop(*held, "before-odometry");
    held_.erase(held_.begin(), kept);
    log_counts_.erase(log_counts_.begin(), log_counts_.lower_bound(stamp));
}

void Pipeline::drop(const Held& held, const std::string& reason) {
    for (const HeldReading& one : held.readings) drops_.add(one.reading.sensor.label, reason);
    for (const auto& scan : held.scans) drops_.add(scan->sensorLabel, reason);
}

void Pipeline::start(Stamp stamp) {
    dropHeldBefore(stamp);
    Start begin;
    begin.stamp = stamp;
    begin.seed = config_.seed;
    begin.threads = threads_;
    const double position = config_.start.position_std, heading = config_.start.heading_std;
    begin.pose.covariance = Vector3(position * position, position * position, heading * heading).asDiagonal();
    switch (config_.start.kind) {
        case StartPose::zero:
            break;
        case StartPose::given:
            begin.pose.mean = config_.start.pose;
            break;
        case StartPose::truth: {
            const auto pose = truth_ ? truth_->robotAt(stamp) : std::nullopt;
            if (!pose || std::isnan(pose->theta))
                throw ConfigError(fmt::format("[start] pose = truth, but {} at {}, where the run starts",
                                              !truth_ ? "no truth was given"
                                              : pose  ? "the truth has no heading of the robot"
                                                      : "the truth has no robot pose",
                                              slamot::toText(stamp)));
            begin.pose.mean = *pose;
            break;
        }
    }
    estimator_.start(begin);
    started_ = true;
}

void Pipeline::advance(const OdometryIncrement& odometry) {
    if (const std::string missing = estimator_.missingInOdometry(odometry); !missing.empty())
        throw ConfigError(
            fmt::format("the log's odometry has no {}, which [motion] model needs, expected model = arc or "
                        "increment for this log",
                        missing));
    if (odometry.seconds() > config_.max_odometry_gap) ++counts_.odometry_gaps;
    OdometryIncrement rest = odometry;
    for (const Held& held : held_) {
        predictTo(rest, held.stamp);
        take(held);
    }
    held_.clear();
    predictTo(rest, odometry.t1);
    last_increment_ = odometry;
}

void Pipeline::predictTo(OdometryIncrement& rest, Stamp stamp) {
    if (stamp <= estimator_.time()) return;
    OdometryIncrement piece = rest;
    if (stamp < rest.t1) {
        OdometrySplit pieces = split(rest, stamp);
        piece = pieces.before;
        rest = pieces.after;
    }
    closeStep();
    const StageClock clock(step_.times.predict, step_.times.predict_cpu, threads_);
    estimator_.predict(piece);
}

void Pipeline::take(const Held& held) {
    DetectionSet set;
    set.stamp = held.stamp;
    auto& range_bearing = std::get<RangeBearingSet>(set.measurements);
    for (const HeldReading& reading : held.readings)
        builder_.append(reading, range_bearing, step_.log_numbers);
    std::vector<Detected> detected;
    for (const auto& scan : held.scans) {
        const StageClock clock(step_.times.detect, step_.times.detect_cpu, threads_);
        detected.push_back(detector_->detect(*scan, estimator_.robot()));
        appendSet(detected.back().detections, range_bearing);
    }
    step_.log_count = log_counts_[held.stamp];
    log_counts_.erase(log_counts_.begin(), log_counts_.upper_bound(held.stamp));
    for (int next = step_.log_count; step_.log_numbers.size() < range_bearing.detections.size();)
        step_.log_numbers.push_back(next++);  // found in scans: after the log's own
    {
        const StageClock clock(step_.times.update, step_.times.update_cpu, threads_);
        step_.report = estimator_.update(set);
    }
    for (std::size_t i = 0; i < held.scans.size(); ++i) {
        const StageClock clock(step_.times.detect, step_.times.detect_cpu, threads_);
        detector_->integrate(*held.scans[i], estimator_.robot(), detected[i].classes);
    }
    step_.has_detections = true;
    ++counts_.detection_sets;
    counts_.detections += static_cast<std::int64_t>(range_bearing.detections.size());
    step_.detections = std::move(set);
}

void Pipeline::closeStep() {
    step_.estimate = estimator_.estimate();
    std::vector<LandmarkId> touched;
    for (const Innovation& innovation : step_.report.innovations)
        if (innovation.landmark.valid()) touched.push_back(innovation.landmark);
    if (!touched.empty()) step_.touched = estimator_.landmarks(touched);
    step_.estimator = &estimator_;
    counts_.times += step_.times;
    for (Sink* sink : sinks_) sink->step(step_);
    last_estimate_ = std::move(step_.estimate);
    step_ = {};
}

void Pipeline::drain() {
    if (!started_) {
        for (const Held& held : held_) drop(held, "before-odometry");
        held_.clear();
        return;
    }
    const Stamp last_odometry = estimator_.time();
    for (const Held& held : held_) {
        const double beyond = secondsBetween(last_odometry, held.stamp);
        const bool reachable = beyond == 0 || (last_increment_ && beyond <= config_.max_odometry_gap);
        if (!reachable) {
            drop(held, "after-odometry");
            continue;
        }
        if (beyond > 0) {
            OdometryIncrement beyond_last = extrapolate(*last_increment_, held.stamp);
            predictTo(beyond_last, held.stamp);
            last_increment_ = beyond_last;
            ++counts_.extrapolated;
        }
        take(held);
    }
    held_.clear();
}

void Pipeline::finish(RunStatus status) {
    drain();
    RunEnd end;
    end.status = status;
    if (started_) {
        closeStep();
        end.estimate = estimator_.estimate();
        end.landmarks = estimator_.landmarks();
        end.estimator = &estimator_;
    }
    endSinks(end);
}

void Pipeline::fail() {
    RunEnd end;
    end.status = RunStatus::failed;
    end.estimate = last_estimate_;
    endSinks(end);
}

void Pipeline::endSinks(const RunEnd& end) {
    while (ended_ < sinks_.size()) sinks_[ended_++]->end(end);
}

}  // namespace slamot::run

#include "conformance/Play.h"

#include <slamot/core/plugin/PluginRegistry.h>
#include <slamot/sim/Simulation.h>

#include <type_traits>

namespace slamot::conformance {
namespace {

ObjectKind kindOf(const std::string& label) {
    if (label == "landmarks") return ObjectKind::landmark;
    return label == "movers" ? ObjectKind::mover : ObjectKind::unknown;
}

void append(const RangeBearingReading& reading, RangeBearingSet& set) {
    for (const auto& item : reading.items) {
        RangeBearingDetection detection;
        detection.range = item.range;
        detection.bearing = wrapAngle(item.bearing);
        detection.covariance = item.covariance;
        detection.kind = kindOf(reading.sensor.label);
        detection.source = item.id;
        detection.sensor = static_cast<int>(set.sensors.size());
        set.detections.push_back(detection);
    }
    set.sensors.push_back(reading.sensor);
}

class Bits {
  public:
    template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
    void add(Number value) {
        text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    template <class Derived>
    void add(const Eigen::MatrixBase<Derived>& matrix) {
        for (Eigen::Index j = 0; j < matrix.cols(); ++j)
            for (Eigen::Index i = 0; i < matrix.rows(); ++i) add(matrix(i, j));
    }
    void add(const std::string& text) { text_ += text; }
    std::string take() { return std::move(text_); }

  private:
    std::string text_;
};

}  // namespace

std::shared_ptr<Estimator> createSubject(const Options& options) {
    if (options.create) return options.create();
    static const PluginRegistry registry = PluginRegistry::discover();
    return registry.createEstimator(options.plugin);
}

Play playOf(const sim::Scenario& scenario, std::uint64_t seed) {
    sim::SimulatedLog log = std::move(sim::simulate(scenario, seed).at(0));
    Play play;
    play.motion = scenario.robots.at(0).motion;
    play.truth = std::move(log.truth);
    play.start.stamp = log.odometry.front().stamp;
    play.start.pose.mean = play.truth.robot.front().pose;
    play.start.seed = seed;

    auto scan = log.scans.begin();
    for (std::size_t i = 0; i < log.odometry.size(); ++i) {
        PlayStep step;
        const OdometryReading& now = log.odometry[i];
        if (i > 0) {
            const OdometryReading& before = log.odometry[i - 1];
            OdometryIncrement odometry;
            odometry.t0 = before.stamp;
            odometry.t1 = now.stamp;
            odometry.increment = inverse(before.pose) * now.pose;
            odometry.velocity = now.velocity;
            odometry.entry_seconds = odometry.seconds();
            step.odometry = odometry;
        }
        for (; scan != log.scans.end() && scan->reading.stamp == now.stamp; ++scan) {
            if (!step.detections) step.detections.emplace().stamp = now.stamp;
            append(scan->reading, std::get<RangeBearingSet>(step.detections->measurements));
        }
        play.steps.push_back(std::move(step));
    }
    return play;
}

Matrix3 turned(const Matrix3& covariance, double angle) {
    Matrix3 R = Matrix3::Identity();
    R.topLeftCorner<2, 2>() = rotation(angle);
    return R * covariance * R.transpose();
}

Play movedBy(const Pose2& T, Play play) {
    play.start.pose.mean = T * play.start.pose.mean;
    play.start.pose.covariance = turned(play.start.pose.covariance, T.theta);
    return play;
}

Config configFor(const Options& options, const Play& play) {
    Config config = Config::fromText(options.config, "conformance options");
    RobotMotionParameters motion = play.motion;
    const ParameterTable table = describe(motion);
    for (const Parameter& parameter : table.parameters())
        config.set(table.section(), parameter.key, parameter.print(), "conformance world");
    return config;
}

std::shared_ptr<Estimator> subjectFor(const Options& options, const Play& play) {
    auto estimator = createSubject(options);
    estimator->initialize(configFor(options, play));
    return estimator;
}

void playSteps(Estimator& estimator, const Play& play, std::size_t first, std::size_t last,
               const Watch& watch) {
    for (std::size_t i = first; i < last; ++i) {
        const PlayStep& step = play.steps[i];
        if (step.odometry) {
            estimator.predict(*step.odometry);
            if (watch) watch(estimator, nullptr);
        }
        if (step.detections) {
            const UpdateReport report = estimator.update(*step.detections);
            if (watch) watch(estimator, &report);
        }
    }
}

void playAll(Estimator& estimator, const Play& play, const Watch& watch) {
    estimator.start(play.start);
    playSteps(estimator, play, 0, play.steps.size(), watch);
}

std::string bits(const Estimate& estimate) {
    Bits out;
    out.add(estimate.stamp.ticks);
    out.add(estimate.robot.mean.vector());
    out.add(estimate.robot.covariance);
    out.add(estimate.landmark_count);
    for (const TrackEstimate& track : estimate.tracks) {
        out.add(track.id.value);
        out.add(track.source.value);
        out.add(track.mean);
        out.add(track.covariance);
        out.add(track.existence);
        for (const double p : track.mode_probabilities) out.add(p);
    }
    return out.take();
}

std::string bitsOfRun(Estimator& estimator, const Play& play) {
    Bits out;
    playAll(estimator, play,
            [&](const Estimator& now, const UpdateReport*) { out.add(bits(now.estimate())); });
    for (const LandmarkEstimate& landmark : estimator.landmarks()) {
        out.add(landmark.id.value);
        out.add(landmark.source.value);
        out.add(landmark.mean);
        out.add(landmark.covariance);
        out.add(landmark.seen);
    }
    out.add(estimator.jointCovariance().matrix);
    return out.take();
}

}  // namespace slamot::conformance

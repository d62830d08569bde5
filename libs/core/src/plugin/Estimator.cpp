#include "slamot/core/plugin/Estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "slamot/core/estimation/Definiteness.h"
#include "DetectionCheck.h"

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Estimator, mrpt::rtti::CObject, slamot)

namespace slamot {
namespace {

/// Sums of 100,000 weights are rounded by far less.
constexpr double weight_tolerance = 1e-9;

bool finite(const Pose2& pose) {
    return pose.vector().allFinite();
}

}  // namespace

Estimator::Estimator() : COutputLogger("Estimator") {}
Estimator::~Estimator() = default;

std::vector<ParameterTable> Estimator::parameterTables() {
    return onParameters();
}

void Estimator::initialize(const Config& config) {
    setLoggerName(name());
    for (const ParameterTable& table : onParameters()) load(table, config);
    onInitialize(config);
    initialized_ = true;
    started_ = false;
}

void Estimator::start(const Start& start) {
    if (!initialized_) throw EstimatorError(name() + ": start before initialize");
    if (!finite(start.pose.mean) || !isPositiveSemidefinite(start.pose.covariance, definiteness_tolerance))
        throw EstimatorError(name() + ": the start pose is not finite or its covariance not positive semi-definite");
    start_ = start;
    now_ = start.stamp;
    health_ = {};
    onStart(start);
    started_ = true;
}

void Estimator::requireStarted(const char* what) const {
    if (!started_) throw EstimatorError(fmt::format("{}: {} before start", name(), what));
}

void Estimator::predict(const OdometryIncrement& odometry) {
    requireStarted("predict");
    if (odometry.t1 < odometry.t0 || odometry.t0 < now_)
        throw TimeOrderError(fmt::format("{}: odometry over ({}, {}] cannot follow time {}", name(),
                                         toText(odometry.t0), toText(odometry.t1), toText(now_)));
    if (odometry.t0 != now_)
        throw TimeOrderError(fmt::format("{}: odometry starts at {}, after the present time {}: a gap", name(),
                                         toText(odometry.t0), toText(now_)));
    const auto& v = odometry.velocity;
    if (!finite(odometry.increment) || (v && !(std::isfinite(v->vx) && std::isfinite(v->vy) && std::isfinite(v->omega))))
        throw EstimatorError(fmt::format("{}: odometry at {} is not finite", name(), toText(odometry.t1)));
    if (odometry.covariance && !isPositiveSemidefinite(*odometry.covariance, definiteness_tolerance))
        throw EstimatorError(fmt::format("{}: odometry at {} has a covariance that is not positive semi-definite",
                                         name(), toText(odometry.t1)));
    try {
        onPredict(odometry);
    } catch (const std::domain_error& error) {
        throw EstimatorError(fmt::format("{}: predict to {}: {}", name(), toText(odometry.t1), error.what()));
    }
    now_ = odometry.t1;
    ++health_.predictions;
    checkRobot("predict");
}

UpdateReport Estimator::update(const DetectionSet& detections) {
    requireStarted("update");
    if (detections.stamp != now_)
        throw TimeOrderError(fmt::format("{}: detections of {} at time {}", name(), toText(detections.stamp),
                                         toText(now_)));
    const RangeBearingSet& set = detections.rangeBearing();
    for (std::size_t i = 0; i < set.detections.size(); ++i)
        if (const std::string reason = problemOf(set.detections[i], set.sensors.size()); !reason.empty())
            throw EstimatorError(
                fmt::format("{}: detection {} at {} {}", name(), i, toText(detections.stamp), reason));

    UpdateReport report;
    try {
        report = onUpdate(detections);
    } catch (const std::domain_error& error) {
        throw EstimatorError(fmt::format("{}: update at {}: {}", name(), toText(now_), error.what()));
    }
    checkReport(report, set.detections.size());
    ++health_.updates;
    for (const Innovation& innovation : report.innovations) switch (innovation.outcome) {
            case Outcome::updated:
            case Outcome::initiated: ++health_.detections_used; break;
            case Outcome::inflated: ++health_.detections_inflated; break;
            case Outcome::rejected: ++health_.detections_rejected; break;
            case Outcome::tentative: ++health_.detections_tentative; break;
            case Outcome::ignored: ++health_.detections_ignored; break;
        }
    checkRobot("update");
    checkTouched(report);
    return report;
}

void Estimator::checkReport(const UpdateReport& report, std::size_t detections) const {
    for (const Innovation& innovation : report.innovations) {
        if (innovation.detection < 0 || static_cast<std::size_t>(innovation.detection) >= detections)
            throw EstimatorError(fmt::format("{}: update at {}: its report names detection {} of {}", name(), toText(now_),
                                             innovation.detection, detections));
        if (std::isfinite(innovation.nis) && !isPositiveDefinite(innovation.covariance))
            throw EstimatorError(fmt::format("{}: update at {}: innovation covariance S of detection {} is not positive "
                                             "definite",
                                             name(), toText(now_), innovation.detection));
    }
}

void Estimator::checkRobot(const char* after) const {
    const PoseGaussian pose = onRobot();
    if (!finite(pose.mean) || !isPositiveSemidefinite(pose.covariance, definiteness_tolerance))
        throw EstimatorError(
            fmt::format("{}: after {} at {} the robot's pose is not finite or its covariance [x y theta] not positive "
                        "semi-definite",
                        name(), after, toText(now_)));
}

void Estimator::checkTouched(const UpdateReport& report) const {
    const auto touched = [&report](TrackId id) {
        return std::any_of(report.innovations.begin(), report.innovations.end(),
                           [id](const Innovation& innovation) { return innovation.track == id; });
    };
    const std::size_t modes = modeNames().size();
    for (const TrackEstimate& track : onTracks()) {
        if (!touched(track.id)) continue;
        if (!track.mean.allFinite() || !isPositiveSemidefinite(track.covariance, definiteness_tolerance))
            throw EstimatorError(fmt::format(
                "{}: after update at {} track {} is not finite or its covariance not positive semi-definite", name(),
                toText(now_), track.id.value));
        if (track.mode_probabilities.size() != modes)
            throw EstimatorError(fmt::format("{}: track {} has {} mode probabilities, modeNames() names {}", name(),
                                             track.id.value, track.mode_probabilities.size(), modes));
    }
#if !defined(NDEBUG) || defined(SLAMOT_CHECK_JOINT)
    if (!isPositiveSemidefinite(onJointCovariance().matrix, definiteness_tolerance))
        throw EstimatorError(fmt::format("{}: after update at {} the joint covariance is not positive semi-definite",
                                         name(), toText(now_)));
#endif
}

Estimate Estimator::estimate() const {
    requireStarted("estimate");
    return {now_, onRobot(), onTracks(), onLandmarkCount(), health_};
}

std::vector<ParticleEstimate> Estimator::particles() const {
    std::vector<ParticleEstimate> particles = onParticles();
    checkParticles(particles);
    return particles;
}

void Estimator::checkParticles(const std::vector<ParticleEstimate>& particles) const {
    double sum = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const auto& [weight, pose] = particles[i];
        if (!finite(pose.mean) || !pose.covariance.allFinite() || !(weight >= 0 && std::isfinite(weight)))
            throw EstimatorError(fmt::format("{}: particle {} at {} is not finite or its weight {} not a part of 1",
                                             name(), i, toText(now_), weight));
        sum += weight;
    }
    if (!particles.empty() && std::abs(sum - 1) > weight_tolerance)
        throw EstimatorError(fmt::format("{}: the weights of {} particles at {} sum to {} instead of 1", name(),
                                         particles.size(), toText(now_), sum));
}

std::string Estimator::missingInOdometry(const OdometryIncrement&) const {
    return {};
}

std::vector<LandmarkEstimate> Estimator::onLandmarks(const std::vector<LandmarkId>& ids) const {
    std::vector<LandmarkEstimate> out;
    const auto all = onLandmarks();
    for (const LandmarkId id : ids)
        for (const LandmarkEstimate& landmark : all)
            if (landmark.id == id) out.push_back(landmark);
    return out;
}

}  // namespace slamot

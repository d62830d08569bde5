#include "slamot/core/filter/ObjectWatch.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace slamot {
namespace {

TentativeParameters tentativeParameters(const ObjectLifeParameters& p, double velocity_std,
                                        double acceleration_std, double gate_probability) {
    return {p.landmarks,      p.movers,     p.change,        p.decide_probability,
            gate_probability, velocity_std, acceleration_std};
}

}  // namespace

void tellStarted(Innovation& innovation, LandmarkId landmark) {
    innovation.kind = ObjectKind::landmark;
    innovation.landmark = landmark;
    innovation.outcome = Outcome::initiated;
}

void tellStarted(Innovation& innovation, TrackId track) {
    innovation.kind = ObjectKind::mover;
    innovation.track = track;
    innovation.outcome = Outcome::initiated;
}

ObjectWatch::ObjectWatch(const ObjectLifeParameters& parameters, Consistency consistency, double velocity_std,
                         double acceleration_std, double gate_probability)
    : parameters_(parameters),
      consistency_(consistency),
      velocity_std_(velocity_std),
      acceleration_std_(acceleration_std),
      pair_gate_(chiSquareQuantile(gate_probability, 2)),
      tentative_(tentativeParameters(parameters, velocity_std, acceleration_std, gate_probability)),
      kinds_(parameters.change),
      lost_(parameters.reidentify_probability, parameters.reidentify_within) {}

void ObjectWatch::clear() {
    tentative_.clear();
    kinds_.clear();
    lost_.clear();
}

void ObjectWatch::predict(const RelativeStep& step, const TargetModel& model) {
    tentative_.predict(step, model);
    kinds_.predict(step, model);
    lost_.predict(step.dt, model);
}

// --- objects of unknown kind
// ---------------------------------------------------------------------------------------------------

double ObjectWatch::look(BlockId object, double moving, const RangeBearingSet& seen, int detection) {
    return kinds_.look(object, moving, seen.detection(detection), seen.sensorOf(detection).pose,
                       consistency_);
}

std::vector<ObjectWatch::Aside> ObjectWatch::lookAside(const std::vector<BlockId>& missed,
                                                       const RangeBearingSet& seen,
                                                       const std::vector<int>& unexplained) {
    std::vector<std::tuple<double, std::size_t, int>> pairs;  // NIS, object, detection
    for (std::size_t object = 0; object < missed.size(); ++object)
        for (const int d : unexplained) {
            if (seen.detection(d).kind != ObjectKind::unknown) continue;
            const auto nis = kinds_.nisAsMover(missed[object], seen.detection(d), seen.sensorOf(d).pose);
            if (nis && *nis <= pair_gate_) pairs.emplace_back(*nis, object, d);
        }
    std::sort(pairs.begin(), pairs.end());

    std::vector<Aside> out;
    std::set<std::size_t> looked;
    std::set<int> taken;
    for (const auto& [nis, object, d] : pairs) {
        if (looked.count(object) > 0 || taken.count(d) > 0) continue;
        looked.insert(object);
        taken.insert(d);
        const RangeBearingSensor& sensor = seen.sensorOf(d);
        const double moving = kinds_.lookAside(missed[object], seen.detection(d), sensor.pose,
                                               parameters_.landmarks.detection_probability,
                                               unexplainedDensity(parameters_.landmarks, sensor));
        out.push_back({object, d, moving});
    }
    return out;
}

RelativeGaussian ObjectWatch::anew(const RangeBearingSet& seen, int detection) const {
    return firstSight(seen.detection(detection), seen.sensorOf(detection).pose, consistency_);
}

RelativeGaussian ObjectWatch::asMover(BlockId object, const RangeBearingSet& seen, int detection) const {
    const RelativeGaussian point = anew(seen, detection);
    RelativeGaussian mover = kinds_.asMover(object);
    mover.mean.head<2>() = point.mean;
    mover.covariance.topRows<2>().setZero();
    mover.covariance.leftCols<2>().setZero();
    mover.covariance.topLeftCorner<2, 2>() = point.covariance;
    return mover;
}

// --- new objects and old ones
// ---------------------------------------------------------------------------------------------------

std::vector<ConfirmedObject> ObjectWatch::confirmed(const RangeBearingSet& seen, Stamp now,
                                                    const std::vector<int>& unexplained,
                                                    const std::vector<bool>& may_start) {
    lost_.forgetOld(now);
    return tentative_.update(seen, now, unexplained, may_start, consistency_);
}

RelativeGaussian ObjectWatch::firstMover(const TentativeObject& object) const {
    const RelativeGaussian mover = object.track.asMover();
    if (parameters_.birth == TrackBirth::two_point) return mover;
    return moverAt({mover.mean.head<2>(), mover.covariance.topLeftCorner<2, 2>()}, velocity_std_,
                   acceleration_std_);
}

void ObjectWatch::lost(const TrackRecord& track, const TargetBelief& last, Stamp now) {
    lost_.add({track.id, last.mean, last.covariance, now});
    kinds_.forget(track.block);
}

}  // namespace slamot

#include "slamot/core/objects/TentativeObjects.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/association/GlobalNearestNeighbour.h"
#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace {

constexpr double least_per_scan = 1e-6;

}  // namespace

double unexplainedDensity(const LifeParameters& life, const RangeBearingSensor& sensor) {
    return clutterDensity(std::max(life.clutter_per_scan + life.new_per_scan, least_per_scan), sensor);
}

std::vector<double> unexplainedDensities(const LifeParameters& landmarks, const LifeParameters& movers,
                                         const RangeBearingSet& seen) {
    std::vector<double> out;
    for (const RangeBearingDetection& detection : seen.detections) {
        const LifeParameters& life = detection.kind == ObjectKind::mover ? movers : landmarks;
        out.push_back(unexplainedDensity(life, seen.sensorOf(detection)));
    }
    return out;
}

/// What an update is given.
struct TentativeObjects::Batch {
    const RangeBearingSet& seen;
    Stamp now;
    const std::vector<int>& unexplained;
    const std::vector<bool>& may_start;
    Consistency consistency;
};

void TentativeObject::keep(const TentativeSight& sight) {
    if (sights.size() == most_sights) sights.erase(sights.begin());
    sights.push_back(sight);
}

TentativeObjects::TentativeObjects(const TentativeParameters& parameters)
    : parameters_(parameters), gates_(parameters.gate_probability) {}

void TentativeObjects::predict(const RelativeStep& step, const TargetModel& model) {
    for (TentativeObject& object : objects_) object.track.predict(step, model, parameters_.change);
}

std::vector<ConfirmedObject> TentativeObjects::update(const RangeBearingSet& seen, Stamp now,
                                                      const std::vector<int>& unexplained,
                                                      const std::vector<bool>& may_start,
                                                      Consistency consistency) {
    for (TentativeObject& object : objects_)
        object.existence.pass(secondsBetween(last_update_, now), lifeOf(object.kind));
    last_update_ = now;

    const Batch batch{seen, now, unexplained, may_start, consistency};
    std::vector<int> detection_of(objects_.size(), -1);  // the last one; -1: none
    for (int sensor = 0; sensor < static_cast<int>(seen.sensors.size()); ++sensor)
        look(sensor, batch, detection_of);

    std::vector<ConfirmedObject> confirmed = takeConfirmed(detection_of);
    const auto gone = [&](const TentativeObject& object) {
        return object.existence.lost(lifeOf(object.kind)) ||
               secondsBetween(object.last_seen, now) > parameters_.max_unseen;
    };
    objects_.erase(std::remove_if(objects_.begin(), objects_.end(), gone), objects_.end());
    return confirmed;
}

DetectionModel TentativeObjects::detectionModel(const Batch& batch,
                                                const std::vector<int>& detections) const {
    DetectionModel model;
    model.gate_probability = parameters_.gate_probability;
    for (const TentativeObject& object : objects_)
        model.detection_probability.push_back(lifeOf(object.kind).detection_probability *
                                              object.existence.visibility() / object.existence.probability());
    for (const int d : detections)
        model.clutter_density.push_back(
            unexplainedDensity(lifeOf(batch.seen.detection(d).kind), batch.seen.sensorOf(d)));
    return model;
}

AssociationProblem TentativeObjects::candidates(const Batch& batch, const std::vector<int>& detections,
                                                const std::vector<ExpectedDetection>& expected) {
    const double gate = gates_(1);
    std::vector<Candidate> pairs;
    for (std::size_t i = 0; i < detections.size(); ++i) {
        const RangeBearingDetection& detection = batch.seen.detection(detections[i]);
        const Pose2& sensor = batch.seen.sensorOf(detections[i]).pose;
        for (std::size_t o = 0; o < objects_.size(); ++o) {
            const TentativeObject& object = objects_[o];
            if (detection.kind != object.kind && detection.kind != ObjectKind::unknown) continue;
            if (!rowsLieWithin(gate, expected[o], detection)) continue;
            const auto match = object.track.match(detection, sensor);
            if (match.nis <= gate)
                pairs.push_back({static_cast<int>(i), static_cast<int>(o), match.nis, match.log_likelihood});
        }
    }
    return {static_cast<int>(detections.size()), size(), std::move(pairs)};
}

void TentativeObjects::look(int sensor_number, const Batch& batch, std::vector<int>& detection_of) {
    const RangeBearingSensor& sensor = batch.seen.sensors[static_cast<std::size_t>(sensor_number)];
    std::vector<int> detections;
    for (const int d : batch.unexplained)
        if (batch.seen.detection(d).sensor == sensor_number) detections.push_back(d);
    std::vector<ExpectedDetection> expected;
    for (const TentativeObject& object : objects_) expected.push_back(object.track.expected(sensor.pose));

    const DetectionModel model = detectionModel(batch, detections);
    const AssociationProblem problem = candidates(batch, detections, expected);
    const Pairing pairing = globalNearestNeighbour(problem, model);

    std::vector<bool> is_seen(objects_.size(), false);
    std::vector<int> alone;
    for (std::size_t i = 0; i < detections.size(); ++i) {
        const int c = pairing.of(static_cast<int>(i));
        if (c < 0) {
            alone.push_back(detections[i]);
            continue;
        }
        const auto o = static_cast<std::size_t>(problem.candidate(c).object);
        TentativeObject& object = objects_[o];
        const double density =
            lifeOf(object.kind).detection_probability * std::exp(problem.candidate(c).log_likelihood);
        object.existence.detected(density / model.clutter_density[i]);
        object.track.update(batch.seen.detection(detections[i]), sensor.pose);
        object.keep({batch.now, batch.seen.detection(detections[i]), sensor.pose,
                     unexplainedDensity(lifeOf(object.kind), sensor)});
        object.seen += 1;
        object.last_seen = batch.now;
        is_seen[o] = true;
        detection_of[o] = detections[i];
    }
    for (std::size_t o = 0; o < objects_.size(); ++o)
        if (!is_seen[o] && reports(sensor, objects_[o].kind))
            objects_[o].existence.missed(lifeOf(objects_[o].kind).detection_probability *
                                         probabilityInView(sensor, expected[o]));

    for (const int d : alone)
        if (batch.may_start[static_cast<std::size_t>(d)] && start(d, batch)) detection_of.push_back(d);
}

bool TentativeObjects::start(int detection, const Batch& batch) {
    const RangeBearingDetection& seen = batch.seen.detection(detection);
    const Existence existence(lifeOf(seen.kind));
    if (!(existence.probability() > 0)) return false;  // no new objects are expected
    const RangeBearingSensor& sensor = batch.seen.sensorOf(detection);
    const RelativeGaussian point = firstSight(seen, sensor.pose, batch.consistency);
    const auto track = [&] {
        switch (seen.kind) {
            case ObjectKind::landmark:
                return RelativeTrack::still(point);
            case ObjectKind::mover:
                return RelativeTrack::moving(point, parameters_.velocity_std, parameters_.acceleration_std);
            case ObjectKind::unknown:
                break;
        }
        return RelativeTrack::unknown(point, parameters_.change);
    };
    objects_.push_back({seen.kind,
                        existence,
                        track(),
                        1,
                        batch.now,
                        batch.now,
                        {{batch.now, seen, sensor.pose, unexplainedDensity(lifeOf(seen.kind), sensor)}}});
    return true;
}

std::vector<ConfirmedObject> TentativeObjects::takeConfirmed(const std::vector<int>& detection_of) {
    std::vector<ConfirmedObject> confirmed;
    std::vector<TentativeObject> rest;
    for (std::size_t o = 0; o < objects_.size(); ++o) {
        const TentativeObject& object = objects_[o];
        const std::optional<bool> moving = moves(object);
        if (detection_of[o] >= 0 && moving && object.existence.confirmed(lifeOf(object.kind)))
            confirmed.push_back({detection_of[o], *moving, object});
        else
            rest.push_back(object);
    }
    objects_ = std::move(rest);
    std::sort(confirmed.begin(), confirmed.end(),
              [](const auto& a, const auto& b) { return a.detection < b.detection; });
    return confirmed;
}

std::optional<bool> TentativeObjects::moves(const TentativeObject& object) const {
    if (object.kind != ObjectKind::unknown) return object.kind == ObjectKind::mover;
    const double p = object.track.movingProbability();
    if (p >= parameters_.decide_probability) return true;
    if (p <= 1 - parameters_.decide_probability) return false;
    return std::nullopt;
}

}  // namespace slamot

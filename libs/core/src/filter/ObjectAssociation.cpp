#include "slamot/core/filter/ObjectAssociation.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/objects/FieldOfView.h"
#include "slamot/core/objects/TentativeObjects.h"

namespace slamot {
namespace {

/// [m] by which landmarks may lie off where they are looked for, beyond what the robot's covariance says.
constexpr double view_margin = 1.0;

/// The sensor with limits that contain what it has just detected: readings beyond the stated ones come from
/// somewhere too.
RangeBearingSensor reaching(const RangeBearingSet& seen, int number) {
    RangeBearingSensor sensor = seen.sensors[static_cast<std::size_t>(number)];
    for (const RangeBearingDetection& detection : seen.detections) {
        if (detection.sensor != number) continue;
        sensor.max_range = std::max(sensor.max_range, detection.range);
        sensor.min_range = std::min(sensor.min_range, detection.range);
        sensor.field_of_view = std::max(sensor.field_of_view, 2 * std::abs(detection.bearing));
    }
    return sensor;
}

}  // namespace

ObjectAssociation::ObjectAssociation(const AssociationParameters& parameters, const LifeParameters& landmarks,
                                     const LifeParameters& movers, Consistency consistency)
    : parameters_(parameters),
      landmark_life_(landmarks),
      mover_life_(movers),
      associator_(parameters, consistency) {}

void ObjectAssociation::byIdentity(ObjectCatalogue& objects, const RangeBearingSet& seen,
                                   std::vector<Innovation>& innovations, KnownObjects& known) {
    for (Innovation& innovation : innovations) {
        const RangeBearingDetection& detection =
            seen.detections[static_cast<std::size_t>(innovation.detection)];
        if (!detection.source.valid() || detection.kind == ObjectKind::unknown) continue;
        innovation.outcome = Outcome::initiated;
        if (detection.kind == ObjectKind::mover) {
            if (const TrackRecord* track = objects.trackBySource(detection.source)) {
                innovation.track = track->id;
                known.targets.push_back({innovation.detection, track->block});
            }
        } else if (const LandmarkRecord* landmark = objects.landmarkBySource(detection.source)) {
            innovation.landmark = landmark->id;
            known.landmarks.push_back({innovation.detection, landmark->block});
        }
    }
}

bool ObjectAssociation::isAssociated(const RangeBearingDetection& detection) const {
    if (detection.source.valid() && detection.kind != ObjectKind::unknown) return false;
    const bool landmarks = parameters_.landmarks != LandmarkAssociation::known,
               movers = parameters_.movers != MoverAssociation::known;
    return detection.kind == ObjectKind::landmark ? landmarks
           : detection.kind == ObjectKind::mover  ? movers
                                                  : landmarks && movers;
}

bool ObjectAssociation::concerns(const RangeBearingSet& seen) const {
    return std::any_of(seen.detections.begin(), seen.detections.end(),
                       [this](const RangeBearingDetection& d) { return isAssociated(d); });
}

std::vector<BlockId> ObjectAssociation::landmarksInView(const ModalState& belief,
                                                        const ObjectCatalogue& objects,
                                                        const RangeBearingSet& seen) const {
    const PoseGaussian robot{Pose2::fromVector(belief.mean(robot_block)),
                             belief.covariance(robot_block, robot_block)};
    std::vector<BlockId> out;
    for (std::size_t s = 0; s < seen.sensors.size(); ++s) {
        if (!reports(seen.sensors[s], ObjectKind::landmark) || !(seen.sensors[s].max_range > 0)) continue;
        const std::vector<BlockId> in_view = objects.positions().inView(
            robot, reaching(seen, static_cast<int>(s)), parameters_.gate_probability, view_margin);
        out.insert(out.end(), in_view.begin(), in_view.end());
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

AssociatedBatch ObjectAssociation::associate(ModalState& belief, ObjectCatalogue& objects,
                                             const RangeBearingSet& seen,
                                             std::vector<Innovation>& innovations) {
    AssociatedBatch batch;
    batch.seen = batch.used = seen;
    byIdentity(objects, seen, innovations, batch.known);

    batch.landmarks = landmarksInView(belief, objects, seen);
    std::vector<BlockId> may_be_measured = batch.landmarks;
    for (const auto* sights : {&batch.known.landmarks, &batch.known.targets})
        for (const auto& sight : *sights) may_be_measured.push_back(sight.block);
    belief.attend(seen, may_be_measured);

    // What an identity names is seen already.
    const auto named = [](const std::vector<KnownObjects::Sight>& sights, BlockId block) {
        return std::any_of(sights.begin(), sights.end(), [&](const auto& s) { return s.block == block; });
    };
    std::vector<VisibleObject> visible;
    for (const BlockId block : batch.landmarks)
        if (!named(batch.known.landmarks, block))
            visible.push_back({block, ObjectKind::landmark, landmark_life_.detection_probability,
                               visiblePart(objects.landmarkOf(block)->life)});
    for (const TrackRecord& track : objects.tracks())
        if (!named(batch.known.targets, track.block))
            visible.push_back(
                {track.block, ObjectKind::mover, mover_life_.detection_probability, visiblePart(track.life)});
    std::vector<int> nameless;
    for (std::size_t d = 0; d < seen.detections.size(); ++d)
        if (isAssociated(seen.detections[d])) nameless.push_back(static_cast<int>(d));

    BatchAssociation found = associator_.associate(
        belief, visible, seen, nameless, unexplainedDensities(landmark_life_, mover_life_, seen));
    pair(objects, visible, batch, found, innovations);
    for (const int d : nameless)
        if (found.of_detection[static_cast<std::size_t>(d)].object < 0) batch.unexplained.push_back(d);
    for (std::size_t o = 0; o < visible.size(); ++o)
        if (found.in_doubt[o]) batch.in_doubt.push_back(visible[o].block);
    batch.may_be_new = std::move(found.may_be_new);
    if (found.soft) batch.used.detections = std::move(found.merged);
    return batch;
}

void ObjectAssociation::pair(ObjectCatalogue& objects, const std::vector<VisibleObject>& visible,
                             AssociatedBatch& batch, const BatchAssociation& found,
                             std::vector<Innovation>& innovations) const {
    batch.likelihood_ratio.assign(batch.seen.detections.size(), 0);
    for (Innovation& innovation : innovations) {
        const auto d = static_cast<std::size_t>(innovation.detection);
        const BatchAssociation::Pair& pair = found.of_detection[d];
        if (pair.object < 0) continue;
        const VisibleObject& object = visible[static_cast<std::size_t>(pair.object)];
        batch.likelihood_ratio[d] = pair.likelihood_ratio;
        innovation.kind = object.kind;
        if (object.kind == ObjectKind::mover) {
            innovation.track = objects.trackOf(object.block)->id;
            batch.known.targets.push_back({innovation.detection, object.block, found.soft});
        } else {
            innovation.landmark = objects.landmarkOf(object.block)->id;
            batch.known.landmarks.push_back({innovation.detection, object.block});
        }
    }
}

}  // namespace slamot

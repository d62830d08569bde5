#include "slamot/core/particles/LandmarkFilters.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/association/NearestNeighbour.h"
#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace {

/// [m] by which landmarks may lie off where they are looked for, beyond what a sensor reaches.
constexpr double view_margin = 1.0;

/// Cheap: false for what lies clearly beside the field of view.
bool mayBeInView(const SensorPlace& place, const RangeBearingSensor& sensor, const Vector2& facing,
                 const GaussianPoint& point) {
    const Vector2 rel = point.mean - place.position;
    const double spread = 4 * std::sqrt(point.covariance.trace()), range = rel.norm();
    if (range > sensor.max_range + spread) return false;
    const double half = 0.5 * sensor.field_of_view + (range > spread ? spread / range : pi);
    return half >= pi || rel.dot(facing) >= range * std::cos(half);
}

}  // namespace

LandmarkFilters::Settings::Settings(const LandmarkFilterParameters& p, GaussianTransform t)
    : parameters(p),
      transform(t),
      gate(chiSquareQuantile(p.gate_probability, 2)),
      separation_gate(std::max(gate, chiSquareQuantile(p.separation_probability, 2))) {}

// --- which sight is of which landmark
// ---------------------------------------------------------------------------------------------------

void LandmarkFilters::pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                             Work& work, std::vector<SightRecord>& records) const {
    scan.placesFrom(pose.mean, work.places);
    work.near.clear();
    work.near_of.assign(scan.sights.size(), -1);
    work.expected.resize(scan.sights.size());
    work.may_start.assign(scan.sights.size(), false);
    if (scan.nameless) findNear(pose.mean.head<2>(), scan, work);
    pairNamed(scan, work);
    work.sights.resize(scan.views.size() * work.near.size());
    work.has_sight.assign(work.sights.size(), false);
    if (scan.nameless) pairNameless(settings, pose, scan, work);

    records.assign(scan.sights.size(), {});
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        records[s].may_be_new = work.may_start[s];
        if (sight.may_be_mover) work.may_start[s] = false;
        if (work.near_of[s] < 0) continue;
        const Work::Near& near = work.near[static_cast<std::size_t>(work.near_of[s])];
        PointSight& expected = work.expected[s];
        expected = expectedAt(settings, pose, scan, sight.view, work.near_of[s], work);
        records[s].landmark = landmarks_.at(near.place).id;
        records[s].z = expected.z;
        records[s].S = expected.covariance + sight.R;
    }
}

const PointSight& LandmarkFilters::expectedAt(const Settings& settings, const PoseBelief& pose,
                                              const ParticleScan& scan, int view, int n, Work& work) {
    const std::size_t pair = work.pairOf(view, n);
    if (!work.has_sight[pair]) {
        const auto v = static_cast<std::size_t>(view);
        const GaussianPoint& point = work.near[static_cast<std::size_t>(n)].point;
        work.sights[pair] = pose.isPoint()
                                ? sightOf(point, work.places[v], settings.transform)
                                : sightOf(point, pose, scan.views[v].sensor.pose, settings.transform);
        work.has_sight[pair] = true;
    }
    return work.sights[pair];
}

void LandmarkFilters::findNear(const Vector2& position, const ParticleScan& scan, Work& work) const {
    landmarks_.forEachNear(position, scan.reach + view_margin,
                           [&](Place place, const LandmarkFilter& landmark) {
                               work.near.push_back({place, landmark.point, false, landmark.source.valid()});
                           });
}

void LandmarkFilters::pairNamed(const ParticleScan& scan, Work& work) const {
    const int found = static_cast<int>(work.near.size());
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (!sight.named()) continue;
        work.may_start[s] = !sight.known_as.valid();
        Place place;
        if (!sight.known_as.valid() || !landmarks_.locate(sight.known_as, place)) continue;
        int n = 0;
        while (n < found && !(work.near[static_cast<std::size_t>(n)].place == place)) ++n;
        if (n == found) {
            n = static_cast<int>(work.near.size());
            work.near.push_back({place, landmarks_.at(place).point, false, true});
        }
        work.near[static_cast<std::size_t>(n)].named_now = true;
        work.near_of[s] = n;
    }
}

void LandmarkFilters::pairNameless(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                                   Work& work) const {
    const LandmarkFilterParameters& p = settings.parameters;
    const Matrix2 turn = rotation(pose.mean.z());
    const double pose_variance = pose.factor.topRows<2>().squaredNorm(),
                 turn_variance = pose.factor.row(2).squaredNorm();
    const double log_detection = std::log(p.life.detection_probability);
    work.candidates.clear();
    work.wide.clear();
    work.paired.assign(scan.views.size() * work.near.size(), false);
    // A landmark or mover is detected once at most by a sensor: to each view it is an object of its own.
    const int near_count = static_cast<int>(work.near.size());
    int per_view = near_count;
    for (const Candidate& pair : work.of_movers) per_view = std::max(per_view, near_count + pair.object + 1);
    auto of_mover = work.of_movers.begin();
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (sight.named()) continue;
        const Vector2 at = pose.mean.head<2>() + turn * sight.local;
        const double variance =
            pose_variance + sight.R(0, 0) + sight.z.x() * sight.z.x() * (sight.R(1, 1) + turn_variance);
        const int first = sight.view * per_view;
        for (int n = 0; n < near_count; ++n) {
            const Work::Near& near = work.near[static_cast<std::size_t>(n)];
            if (near.named_now || !mayPair(near.point.mean - at, variance + near.point.covariance.trace(),
                                           settings.separation_gate))
                continue;
            const PointInnovation innovation(expectedAt(settings, pose, scan, sight.view, n, work), sight.z,
                                             sight.R);
            if (innovation.nis > settings.separation_gate) continue;
            Candidate pair{static_cast<int>(s), first + n, innovation.nis, -0.5 * innovation.nis};
            work.wide.push_back(pair);
            if (innovation.nis > settings.gate) continue;
            if (p.association == ParticleAssociation::likelihood) {
                // A landmark that hardly exists takes no harm from a detection of something else: its
                // existence weighs among landmarks, not against that.
                const double visible =
                    std::max(landmarks_.at(near.place).existence.visibility(), least_visible);
                pair.log_likelihood = innovation.logLikelihood() + log_detection;
                if (pair.log_likelihood <= sight.log_unexplained) continue;
                pair.log_likelihood += std::log(visible);
            }
            work.candidates.push_back(pair);
        }
        for (; of_mover != work.of_movers.end() && of_mover->detection == static_cast<int>(s); ++of_mover) {
            work.candidates.push_back(*of_mover);
            work.candidates.back().object += first + near_count;
        }
    }
    const int views = static_cast<int>(scan.views.size());
    const AssociationProblem problem(static_cast<int>(scan.sights.size()), views * per_view, work.candidates);
    const Pairing pairing = nearestNeighbour(problem);
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const int c = pairing.of(static_cast<int>(s));
        if (!scan.sights[s].named()) work.may_start[s] = c < 0;
        if (c < 0) continue;
        const int n = problem.candidate(c).object % per_view;
        if (n >= near_count) continue;
        work.near_of[s] = n;
        work.paired[work.pairOf(scan.sights[s].view, n)] = true;
    }
    // What lies near a landmark that is not seen otherwise may be of it: it starts nothing.
    for (const Candidate& pair : work.wide)
        if (!work.paired[work.pairOf(pair.object / per_view, pair.object % per_view)])
            work.may_start[static_cast<std::size_t>(pair.detection)] = false;
}

// --- what it says
// ---------------------------------------------------------------------------------------------------

void LandmarkFilters::refine(const Settings& settings, const ParticleScan& scan, const Work& work,
                             RefinedPose& pose) const {
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        if (work.near_of[s] < 0) continue;
        const Work::Near& near = work.near[static_cast<std::size_t>(work.near_of[s])];
        if (!near.named && !landmarks_.at(near.place).existence.confirmed(settings.parameters.life)) continue;
        const ScanSight& sight = scan.sights[s];
        const PointSight expected =
            sightOf(near.point, pose.belief(), scan.sensorOf(sight), settings.transform);
        pose.take(expected, PointInnovation(expected, sight.z, sight.R));
    }
}

double LandmarkFilters::update(const Settings& settings, const Vector3& pose, bool drawn,
                               const ParticleScan& scan, Work& work, std::vector<SightRecord>& records) {
    if (drawn) scan.placesFrom(pose, work.places);
    double log_likelihood = 0;
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (!sight.named()) log_likelihood += sight.log_unexplained;
        if (work.near_of[s] < 0) continue;
        const Work::Near& near = work.near[static_cast<std::size_t>(work.near_of[s])];
        const LandmarkFilter& landmark = landmarks_.at(near.place);
        // Named and seen twice in this batch: the second meets what the first has made of it.
        if (drawn || landmark.last_seen == scan.now)
            work.expected[s] = sightOf(landmark.point, work.placeOf(sight), settings.transform);
        records[s].outcome = isConfirmed(settings, landmark) ? Outcome::updated : Outcome::tentative;
        log_likelihood += detected(settings, work.expected[s], sight, scan, near.place);
    }
    if (scan.nameless) log_likelihood += missed(settings, scan, work);
    log_likelihood += startNew(settings, scan, work, records);
    if (scan.nameless) letGo(settings, scan.now, work);
    return log_likelihood;
}

double LandmarkFilters::detected(const Settings& settings, const PointSight& expected, const ScanSight& sight,
                                 const ParticleScan& scan, Place place) {
    const LifeParameters& life = settings.parameters.life;
    LandmarkFilter& landmark = landmarks_.write(place);
    const PointInnovation innovation(expected, sight.z, sight.R);
    slamot::update(landmark.point, expected, innovation);
    landmarks_.moved(place);
    ++landmark.seen;
    landmark.last_seen = scan.now;
    if (sight.named()) return innovation.logLikelihood();

    // The landmark is detected, or it is not and the detection is of something else.
    landmark.existence.pass(secondsBetween(landmark.looked, scan.now), life);
    landmark.looked = scan.now;
    const double in_view = probabilityInView(scan.viewOf(sight).sensor, {expected.z, expected.covariance});
    const double seen = life.detection_probability * std::max(in_view, least_in_view);
    const double ratio = seen * std::exp(innovation.logLikelihood() - sight.log_unexplained);
    const double visible = landmark.existence.visibility();
    landmark.existence.detected(ratio);
    return std::log(visible * ratio + 1 - visible * seen);
}

double LandmarkFilters::missed(const Settings& settings, const ParticleScan& scan, Work& work) {
    const LifeParameters& life = settings.parameters.life;
    double log_likelihood = 0;
    work.lost.clear();
    for (std::size_t v = 0; v < scan.views.size(); ++v) {
        const ScanView& view = scan.views[v];
        if (!view.nameless) continue;
        const SensorPlace& sensor = work.places[v];
        const Vector2 facing(std::cos(sensor.heading), std::sin(sensor.heading));
        for (std::size_t n = 0; n < work.near.size(); ++n) {
            const Work::Near& near = work.near[n];
            if (near.named || work.paired[work.pairOf(static_cast<int>(v), static_cast<int>(n))] ||
                !mayBeInView(sensor, view.sensor, facing, near.point))
                continue;
            const PointSight expected = sightOf(near.point, sensor, GaussianTransform::linear);
            const double seen = life.detection_probability *
                                probabilityInView(view.sensor, {expected.z, expected.covariance});
            if (seen < 1e-3) continue;
            LandmarkFilter& landmark = landmarks_.write(near.place);
            landmark.existence.pass(secondsBetween(landmark.looked, scan.now), life);
            landmark.looked = scan.now;
            log_likelihood += std::log1p(-seen * landmark.existence.visibility());
            landmark.existence.missed(seen);
            if (landmark.existence.lost(life)) work.lost.push_back(near.place);
        }
    }
    return log_likelihood;
}

// --- what comes and goes
// ---------------------------------------------------------------------------------------------------

double LandmarkFilters::startNew(const Settings& settings, const ParticleScan& scan, Work& work,
                                 std::vector<SightRecord>& records) {
    double log_likelihood = 0;
    int view = -1;
    const bool expects_new = Existence(settings.parameters.life).probability() > 0;
    work.begun.assign(scan.sights.size(), {});
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (sight.view != view) pairWithBegun(settings, scan, view = sight.view, work);
        if (!work.may_start[s] || !(sight.named() || expects_new)) continue;
        records[s].outcome = sight.named() ? Outcome::initiated : Outcome::tentative;
        records[s].landmark = work.begun[s].valid() ? work.begun[s] : sight.birth;
        Place place;
        if (work.begun[s].valid() && landmarks_.locate(work.begun[s], place)) {
            const PointSight expected =
                sightOf(landmarks_.at(place).point, work.placeOf(sight), settings.transform);
            log_likelihood += detected(settings, expected, sight, scan, place);
        } else {
            start(settings, work.placeOf(sight), sight, scan.now);
        }
    }
    return log_likelihood;
}

void LandmarkFilters::pairWithBegun(const Settings& settings, const ParticleScan& scan, int view,
                                    Work& work) const {
    std::vector<const LandmarkFilter*> begun;
    for (const ScanSight& sight : scan.sights)
        if (sight.view < view && !sight.named())
            if (const LandmarkFilter* landmark = landmarks_.find(sight.birth)) begun.push_back(landmark);
    if (begun.empty()) return;
    work.candidates.clear();
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (sight.view != view || sight.named() || !work.may_start[s]) continue;
        for (std::size_t n = 0; n < begun.size(); ++n) {
            const PointSight expected = sightOf(begun[n]->point, work.placeOf(sight), settings.transform);
            const double nis = PointInnovation(expected, sight.z, sight.R).nis;
            if (nis <= settings.gate)
                work.candidates.push_back({static_cast<int>(s), static_cast<int>(n), nis, -0.5 * nis});
        }
    }
    const AssociationProblem problem(static_cast<int>(scan.sights.size()), static_cast<int>(begun.size()),
                                     work.candidates);
    const Pairing pairing = nearestNeighbour(problem);
    for (std::size_t s = 0; s < scan.sights.size(); ++s)
        if (const int c = pairing.of(static_cast<int>(s)); c >= 0)
            work.begun[s] = begun[static_cast<std::size_t>(problem.candidate(c).object)]->id;
}

void LandmarkFilters::start(const Settings& settings, const SensorPlace& sensor, const ScanSight& sight,
                            Stamp now) {
    LandmarkFilter landmark;
    landmark.id = sight.birth;
    landmark.point = firstSight(sensor, sight.z, sight.R, settings.transform);
    landmark.source = sight.source;
    if (!sight.named()) landmark.existence = Existence(settings.parameters.life);
    landmark.first_seen = landmark.last_seen = landmark.looked = now;
    landmarks_.append(landmark);
}

void LandmarkFilters::remove(LandmarkId id) {
    Place place;
    if (landmarks_.locate(id, place)) landmarks_.remove({place});
}

void LandmarkFilters::letGo(const Settings& settings, Stamp now, Work& work) {
    landmarks_.sweep(work.lost, [&](const LandmarkFilter& landmark) {
        return !isConfirmed(settings, landmark) &&
               secondsBetween(landmark.last_seen, now) > settings.parameters.max_unseen;
    });
    landmarks_.remove(work.lost);
}

std::vector<ParameterTable> describe(LandmarkFilterParameters& p, const std::string& name) {
    ParameterTable association(name + ".association",
                               "Which detection is of which landmark, in each particle.");
    association
        .choice("landmarks", p.association,
                {{"likelihood", ParticleAssociation::likelihood},
                 {"nearest", ParticleAssociation::nearest},
                 {"known", ParticleAssociation::known}},
                "For detections without identity. likelihood: the likeliest pair, where it is likelier than "
                "something new or false; nearest: the smallest NIS; known: they are ignored.")
        .real("gate_probability", p.gate_probability, "-", Interval::openProbability(),
              "Part of a landmark's detections that lie inside its gate.")
        .real("separation_probability", p.separation_probability, "-", Interval::openProbability(),
              "A detection inside this gate of a landmark that is not seen otherwise starts no new one.");
    ParameterTable landmarks(name + ".landmarks", "Life of landmarks without an identity.");
    describe(p.life, "landmarks", landmarks);
    landmarks.real("max_unseen", p.max_unseen, "s", Interval::positiveOrInfinite(),
                   "A landmark that is not confirmed and not seen for longer is let go.");
    return {association, landmarks};
}

}  // namespace slamot

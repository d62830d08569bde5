#include "slamot/core/particles/BernoulliMap.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/association/AssociationMarginals.h"
#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/objects/FieldOfView.h"

namespace slamot {
namespace {

using Place = BernoulliMap::Place;

bool operator==(Place a, Place b) {
    return a.page == b.page && a.item == b.item;
}

/// Beyond a sensor's limits by these a feature may still be detected, since poses and limits are not that exact.
constexpr double range_rim = 0.3, bearing_rim = 0.04;  // [m], [rad]; standard deviations
constexpr double widest_rim = 4;                       ///< of these
constexpr double least_in_view = 0.02;                 ///< within that, whatever the limits say

/// Pairs less likely than this are left out of the mixture: they would move nothing.
constexpr double least_pair = 1e-6;

/// Cheap: false for what lies clearly beside the field of view.
bool mayBeInView(const Vector3& pose, const ScanView& view, const GaussianPoint& point) {
    const Vector2 rel = point.mean - pose.head<2>() - rotation(pose.z()) * view.sensor.pose.position();
    const double spread = widest_rim * (range_rim + std::sqrt(point.covariance.trace())), range = rel.norm();
    if (range > view.sensor.max_range + spread) return false;
    const double half =
        0.5 * view.sensor.field_of_view + widest_rim * bearing_rim + (range > spread ? spread / range : pi);
    if (half >= pi) return true;
    const double direction = pose.z() + view.sensor.pose.theta;
    return rel.x() * std::cos(direction) + rel.y() * std::sin(direction) >= range * std::cos(half);
}

double inView(const RangeBearingSensor& sensor, const PointSight& sight) {
    Matrix2 spread = sight.covariance;
    spread(0, 0) += range_rim * range_rim;
    spread(1, 1) += bearing_rim * bearing_rim;
    return std::max(probabilityInView(sensor, {sight.z, spread}), least_in_view);
}

bool rowsLieWithin(double gate, const Vector2& residual, const Matrix2& S) {
    return residual.x() * residual.x() <= gate * S(0, 0) && residual.y() * residual.y() <= gate * S(1, 1);
}

}  // namespace

BernoulliMap::Settings::Settings(const BernoulliMapParameters& p, GaussianTransform t)
    : parameters(p), transform(t), gate(chiSquareQuantile(p.gate_probability, 2)) {}

// --- which detection may be of what
// ---------------------------------------------------------------------------------------------------

void BernoulliMap::findNear(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, int number,
                            Work& work) const {
    const LifeParameters& life = settings.parameters.life;
    const ScanView& view = scan.views[static_cast<std::size_t>(number)];
    work.near.clear();
    const auto toldByName = [&](const BernoulliFeature& feature) {
        return std::any_of(scan.sights.begin(), scan.sights.end(),
                           [&](const ScanSight& sight) { return sight.known_as == feature.id; });
    };
    const double radius = view.reach + widest_rim * range_rim;
    features_.forEachNear(pose.mean.head<2>(), radius, [&](Place place, const BernoulliFeature& feature) {
        if (!mayBeInView(pose.mean, view, feature.point)) return;
        if (feature.source.valid() && toldByName(feature)) return;
        const PointSight sight = sightOf(feature.point, pose, view.sensor.pose, GaussianTransform::linear);
        Existence existence = feature.existence;
        existence.pass(secondsBetween(feature.looked, scan.now), life);
        work.near.push_back({place, feature.point, sight, existence,
                             life.detection_probability * inView(view.sensor, sight), FeatureMixture()});
    });
}

void BernoulliMap::findCandidates(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                                  int number, Work& work) const {
    const Pose2& sensor = scan.views[static_cast<std::size_t>(number)].sensor.pose;
    work.candidates.clear();
    work.log_ratios.clear();
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (sight.view != number || sight.named()) continue;
        for (std::size_t n = 0; n < work.near.size(); ++n) {
            Work::Near& near = work.near[n];
            const Vector2 residual = rangeBearingResidual(sight.z, near.sight.z);
            if (!rowsLieWithin(settings.gate, residual, near.sight.covariance + sight.R)) continue;
            if (settings.transform != GaussianTransform::linear && pose.isPoint())
                near.sight = sightOf(near.point, pose.mean, sensor, settings.transform);
            const PointInnovation innovation(near.sight, sight.z, sight.R);
            if (innovation.nis > settings.gate) continue;
            const double seen = near.detection * near.existence.visibility();
            if (!(seen > 0)) continue;
            work.candidates.push_back(
                {static_cast<int>(s), static_cast<int>(n), innovation.nis, innovation.log_likelihood});
            work.log_ratios.push_back(std::log(seen) + innovation.log_likelihood - std::log(sight.unexplained) -
                                      std::log1p(-seen));
        }
    }
}

void BernoulliMap::pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work,
                          std::vector<SightRecord>& records) const {
    work.pairs.clear();
    records.assign(scan.sights.size(), {});
    std::vector<double> best(scan.sights.size(), 0);
    const auto tell = [&](std::size_t s, LandmarkId id, const PointSight& sight) {
        records[s].landmark = id;
        records[s].z = sight.z;
        records[s].S = sight.covariance + scan.sights[s].R;
    };
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        const BernoulliFeature* feature = sight.known_as.valid() ? find(sight.known_as) : nullptr;
        if (!feature) continue;
        work.pairs.push_back({static_cast<int>(s), 1.0, feature->point});
        tell(s, feature->id, sightOf(feature->point, pose, scan.sensorOf(sight), settings.transform));
    }
    for (int view = 0; view < static_cast<int>(scan.views.size()); ++view) {
        if (!scan.views[static_cast<std::size_t>(view)].nameless) continue;
        findNear(settings, pose, scan, view, work);
        findCandidates(settings, pose, scan, view, work);
        const AssociationProblem problem(static_cast<int>(scan.sights.size()), static_cast<int>(work.near.size()),
                                         work.candidates);
        const AssociationMarginals marginals =
            associationMarginals(problem, work.log_ratios, settings.parameters.state_budget);
        for (int c = 0; c < problem.candidates(); ++c) {
            const double p = marginals.pair[static_cast<std::size_t>(c)];
            const auto s = static_cast<std::size_t>(problem.candidate(c).detection);
            const Work::Near& near = work.near[static_cast<std::size_t>(problem.candidate(c).object)];
            if (p > best[s] && p >= 0.5) {
                best[s] = p;
                tell(s, features_.at(near.place).id, near.sight);
            }
            if (p >= settings.parameters.pose_probability)
                work.pairs.push_back({static_cast<int>(s), p, near.point});
        }
    }
}

void BernoulliMap::refine(const Settings& settings, const ParticleScan& scan, const Work& work,
                          RefinedPose& pose) const {
    for (const Work::Pair& pair : work.pairs) {
        const ScanSight& sight = scan.sights[static_cast<std::size_t>(pair.sight)];
        const PointSight expected = sightOf(pair.point, pose.belief(), scan.sensorOf(sight), settings.transform);
        pose.take(expected, PointInnovation(expected, sight.z, sight.R));
    }
}

// --- what the scan says of the map
// ---------------------------------------------------------------------------------------------------

double BernoulliMap::update(const Settings& settings, const Vector3& pose, const ParticleScan& scan, Work& work,
                            std::vector<SightRecord>& records) {
    double log_likelihood = 0;
    std::vector<double> none(scan.sights.size());
    work.lost.clear();
    for (int view = 0; view < static_cast<int>(scan.views.size()); ++view) {
        log_likelihood += updateNamed(settings, pose, scan, view, records);
        if (scan.views[static_cast<std::size_t>(view)].nameless)
            log_likelihood += updateNameless(settings, pose, scan, view, work, records, none);
        for (std::size_t s = 0; s < scan.sights.size(); ++s) {
            const ScanSight& sight = scan.sights[s];
            if (sight.view != view) continue;
            const bool starts =
                sight.named() ? !sight.known_as.valid() : none[s] >= settings.parameters.life.remove_probability;
            if (!starts) continue;
            start(settings, pose, scan, sight, sight.named() ? 1 : none[s]);
            if (records[s].landmark.valid()) continue;
            records[s].landmark = sight.birth;
            records[s].outcome = sight.named() ? Outcome::initiated : Outcome::tentative;
        }
    }
    if (scan.nameless) letGo(settings, scan.now, work);
    return log_likelihood;
}

double BernoulliMap::updateNamed(const Settings& settings, const Vector3& pose, const ParticleScan& scan, int view,
                                 std::vector<SightRecord>& records) {
    double log_likelihood = 0;
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        Place place;
        if (sight.view != view || !sight.known_as.valid() || !features_.locate(sight.known_as, place)) continue;
        BernoulliFeature& feature = features_.write(place);
        const PointSight expected = sightOf(feature.point, pose, scan.sensorOf(sight), settings.transform);
        const PointInnovation innovation(expected, sight.z, sight.R);
        slamot::update(feature.point, expected, innovation);
        features_.moved(place);
        ++feature.seen;
        feature.last_seen = scan.now;
        records[s].outcome = Outcome::updated;
        log_likelihood += innovation.log_likelihood;
    }
    return log_likelihood;
}

double BernoulliMap::updateNameless(const Settings& settings, const Vector3& pose, const ParticleScan& scan, int view,
                                    Work& work, std::vector<SightRecord>& records, std::vector<double>& none) {
    const PoseBelief at{pose, Matrix3::Zero()};
    findNear(settings, at, scan, view, work);
    findCandidates(settings, at, scan, view, work);
    const AssociationProblem problem(static_cast<int>(scan.sights.size()), static_cast<int>(work.near.size()),
                                     work.candidates);
    const AssociationMarginals marginals =
        associationMarginals(problem, work.log_ratios, settings.parameters.state_budget);

    double log_likelihood = marginals.log_sum;
    for (const Work::Near& near : work.near)
        log_likelihood += std::log1p(-near.detection * near.existence.visibility());
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (sight.view != view || sight.named()) continue;
        log_likelihood += std::log(sight.unexplained);
        none[s] = marginals.none[s];
    }
    for (int c = 0; c < problem.candidates(); ++c) {
        const double p = marginals.pair[static_cast<std::size_t>(c)];
        if (p < least_pair) continue;
        const auto s = static_cast<std::size_t>(problem.candidate(c).detection);
        const ScanSight& sight = scan.sights[s];
        Work::Near& near = work.near[static_cast<std::size_t>(problem.candidate(c).object)];
        GaussianPoint point = near.point;
        slamot::update(point, near.sight, PointInnovation(near.sight, sight.z, sight.R));
        near.mixture.add(p, point);
        const BernoulliFeature& feature = features_.at(near.place);
        if (records[s].landmark == feature.id)
            records[s].outcome = isConfirmed(settings, feature) ? Outcome::updated : Outcome::tentative;
    }
    for (std::size_t n = 0; n < work.near.size(); ++n)
        take(settings, scan.now, marginals.missed[n], work.near[n], work);
    return log_likelihood;
}

void BernoulliMap::take(const Settings& settings, Stamp now, double missed, Work::Near& near, Work& work) {
    const double seen = near.detection * near.existence.visibility();
    BernoulliFeature& feature = features_.write(near.place);
    feature.existence = near.existence;
    feature.existence.detectedPerhaps(1 - missed, near.detection);
    feature.looked = now;
    if (missed < 1) {
        const double there = missed * (near.existence.probability() - seen) / (1 - seen);
        if (there > least_pair) near.mixture.add(there, near.point);
        feature.point = near.mixture.moments();
        features_.moved(near.place);
    }
    if (missed < 0.5) {
        ++feature.seen;
        feature.last_seen = now;
    }
    if (feature.existence.lost(settings.parameters.life)) work.lost.push_back(near.place);
}

// --- what comes and goes
// ---------------------------------------------------------------------------------------------------

void BernoulliMap::start(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                         const ScanSight& sight, double probability) {
    BernoulliFeature feature;
    feature.id = sight.birth;
    feature.point = firstSight(pose, sight.z, sight.R, scan.sensorOf(sight), settings.transform);
    feature.source = sight.source;
    if (!sight.named()) {
        feature.existence = Existence(settings.parameters.life);
        feature.existence.newWithProbability(probability);
        if (!(feature.existence.probability() > 0)) return;
    }
    feature.first_seen = feature.last_seen = feature.looked = scan.now;
    features_.append(feature);
}

void BernoulliMap::letGo(const Settings& settings, Stamp now, Work& work) {
    // Of what was left behind nothing is missed: one page a scan is looked through for it.
    if (++swept_ >= features_.pages()) swept_ = 0;
    features_.forEachOfPage(swept_, [&](Place place, const BernoulliFeature& feature) {
        if (!isConfirmed(settings, feature) &&
            secondsBetween(feature.last_seen, now) > settings.parameters.max_unseen)
            work.lost.push_back(place);
    });
    std::sort(work.lost.begin(), work.lost.end(),
              [](Place a, Place b) { return a.page != b.page ? a.page < b.page : a.item < b.item; });
    work.lost.erase(std::unique(work.lost.begin(), work.lost.end(), [](Place a, Place b) { return a == b; }),
                    work.lost.end());
    features_.remove(work.lost);
}

std::vector<ParameterTable> describe(BernoulliMapParameters& p, const std::string& name) {
    ParameterTable association(name + ".association", "Which detection is of which landmark, in each particle.");
    association
        .choice("landmarks", p.use_nameless, {{"marginal", true}, {"known", false}},
                "For detections without identity. marginal: of each landmark with its probability over all pairings; "
                "known: they are ignored.")
        .real("gate_probability", p.gate_probability, "-", Interval::openProbability(),
              "Part of a landmark's detections that lie inside its gate.")
        .real("pose_probability", p.pose_probability, "-", Interval::openProbability(),
              "A landmark refines the pose where its detection comes from it with this probability at least.")
        .integer("state_budget", p.state_budget, Interval::between(1, 1000000),
                 "States of the exact sums over pairings at most; beyond, belief propagation approximates them.");
    ParameterTable landmarks(name + ".landmarks", "Life of landmarks without an identity.");
    describe(p.life, "landmarks", landmarks);
    landmarks.real("max_unseen", p.max_unseen, "s", Interval::positiveOrInfinite(),
                   "A landmark that is not confirmed and not seen for longer is let go.");
    return {association, landmarks};
}

}  // namespace slamot

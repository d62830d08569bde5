#include "slamot/core/particles/PhdMap.h"

#include <algorithm>
#include <cmath>

#include "PhdLikelihood.h"

namespace slamot {
namespace {

/// [m] that a pose is drawn from its prediction as a rule. Farther off components are looked up again.
constexpr double draw_margin = 1.0;

/// The world in a sensor's frame.
class SensorFrame {
  public:
    explicit SensorFrame(const SensorPlace& place)
        : to_world_(rotation(place.heading)), origin_(place.position) {}
    Vector2 operator()(const Vector2& point) const { return to_world_.transpose() * (point - origin_); }

  private:
    Matrix2 to_world_;
    Vector2 origin_;
};

/// Cheap: false for pairs that could only make a term too light to be kept. `variance`: of both, on the
/// plane.
bool mayBelong(const PhdSight& sight, const Vector2& at, double weight, double variance) {
    const double widest = sight.widest + (weight > PhdSight::ordinary_weight ? 2 * std::log(weight) : 0);
    return mayPair(at - sight.point, variance, widest);
}

/// P_D w q (eq. 25, 26).
double detectionTerm(const PhdMap::Settings& settings, double weight, const PointInnovation& innovation) {
    return weight * std::exp(settings.log_detection + innovation.logLikelihood());
}

/// By sight the landmark with the largest P_D w q, and the sum over all components.
void weighPairs(const PhdMap::Settings& settings, const PoseBelief& pose, int view, PhdMap::Work& work) {
    const double place_variance = pose.factor.topRows<2>().squaredNorm();
    const double turn_variance = pose.factor.row(2).squaredNorm();
    const Pose2& sensor = work.scan.views[static_cast<std::size_t>(view)].sensor;
    const SensorFrame frame(placeOf(pose.mean, sensor));
    for (std::size_t n = 0; n < work.near.size(); ++n) {
        const PhdMap::Near& near = work.near[n];
        const Vector2 at = frame(near.point.mean);
        const double variance = place_variance + near.point.covariance.trace();
        bool looked = false;
        PointSight expected;
        for (std::size_t s = 0; s < work.pairs.size(); ++s) {
            const PhdSight& sight = work.scan.sights[s];
            if (sight.view != view) continue;
            const double across = sight.z.x() * sight.z.x() * turn_variance;
            if (!mayBelong(sight, at, near.weight, variance + sight.variance + across)) continue;
            // Who is with whom does not hang on how Gaussians are bent: the Jacobian will do.
            if (!looked) expected = sightOf(near.point, pose, sensor, GaussianTransform::linear);
            looked = true;
            const PointInnovation innovation(expected, sight.z, sight.R);
            const double value = detectionTerm(settings, near.weight, innovation);
            work.shares[s].all += value;
            PhdMap::Pair& pair = work.pairs[s];
            if (near.weight > settings.parameters.landmark_above && value > pair.responsibility)
                pair = {static_cast<int>(n), value, expected.z, innovation.S};
        }
    }
}

/// Only pairs with a responsibility above 1/2 are left, and of each landmark's with one sensor the one with
/// the largest.
void decidePairs(PhdMap::Work& work) {
    for (std::size_t s = 0; s < work.pairs.size(); ++s) {
        PhdMap::Pair& pair = work.pairs[s];
        pair.responsibility /= work.shares[s].all;
        if (pair.responsibility <= 0.5) pair.near = -1;
        for (std::size_t other = 0; other < s && pair.near >= 0; ++other) {
            PhdMap::Pair& rival = work.pairs[other];
            if (rival.near == pair.near && work.scan.sights[other].view == work.scan.sights[s].view)
                (rival.responsibility < pair.responsibility ? rival : pair).near = -1;
        }
    }
}

}  // namespace

PhdMap::Settings::Settings(const PhdMapParameters& p, GaussianTransform t)
    : parameters(p),
      transform(t),
      log_detection(std::log(p.detection_probability)),
      birth_weight(p.birthWeight()) {}

// --- which landmark is behind which sight

void PhdMap::pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work,
                    std::vector<SightRecord>& records) const {
    if (work.of != &scan) {
        work.scan = PhdScan(scan, settings.parameters, settings.transform);
        work.of = &scan;
    }
    findNear(pose.mean.head<2>(), work.scan.reach + draw_margin, work);
    const std::size_t sights = work.scan.sights.size();
    work.pairs.assign(sights, {});
    work.shares.assign(sights, {});
    for (std::size_t s = 0; s < sights; ++s) work.shares[s].all = work.scan.sights[s].clutter;
    for (int v = 0; v < static_cast<int>(work.scan.views.size()); ++v) weighPairs(settings, pose, v, work);
    decidePairs(work);

    records.assign(sights, {});
    for (std::size_t s = 0; s < sights; ++s) {
        const Pair& pair = work.pairs[s];
        if (pair.near < 0) continue;
        records[s].outcome = Outcome::updated;
        records[s].landmark = work.near[static_cast<std::size_t>(pair.near)].id;
        records[s].z = pair.z;
        records[s].S = pair.S;
    }
}

void PhdMap::findNear(const Vector2& centre, double radius, Work& work) const {
    work.near.clear();
    work.centre = centre;
    work.radius = radius;
    features_.forEachNear(centre, radius, [&](Place place, const PhdFeature& feature) {
        work.near.push_back({place, feature.id, feature.weight, feature.point});
    });
}

void PhdMap::refine(const Settings& settings, const ParticleScan&, const Work& work,
                    RefinedPose& pose) const {
    for (std::size_t s = 0; s < work.pairs.size(); ++s) {
        if (work.pairs[s].near < 0) continue;
        const GaussianPoint& point = work.near[static_cast<std::size_t>(work.pairs[s].near)].point;
        const PhdSight& sight = work.scan.sights[s];
        const Pose2& sensor = work.scan.viewOf(sight).sensor;
        const PointSight expected = sightOf(point, pose.belief(), sensor, settings.transform);
        pose.take(expected, PointInnovation(expected, sight.z, sight.R));
    }
}

// --- the density's update

namespace {

/// What no component explains starts one.
void begin(const PhdMap::Settings& settings, const Vector3& pose, int view, PhdMap::Work& work) {
    const Matrix2 R = rotation(pose.z());
    for (std::size_t s = 0; s < work.shares.size(); ++s) {
        const PhdSight& sight = work.scan.sights[s];
        PhdMap::Share& share = work.shares[s];
        if (sight.view != view) continue;
        if (settings.parameters.births == PhdBirths::unexplained && share.explained >= 0.5) continue;
        share.numbered = true;
        PhdFeature feature;
        feature.id = sight.birth;
        feature.point = {pose.head<2>() + R * sight.start.mean, R * sight.start.covariance * R.transpose()};
        feature.weight = settings.birth_weight;
        feature.first_seen = feature.last_seen = work.scan.now;
        work.fresh.push_back(feature);
    }
}

/// Sights that no landmark was behind are of what may be one.
void recordTentative(int view, const PhdMap::Work& work, std::vector<SightRecord>& records) {
    for (std::size_t s = 0; s < records.size(); ++s) {
        const PhdSight& sight = work.scan.sights[s];
        if (sight.view != view || records[s].outcome == Outcome::updated) continue;
        const PhdMap::Share& share = work.shares[s];
        const bool known = share.explained >= 0.5;
        records[s].outcome = Outcome::tentative;
        records[s].landmark =
            known ? work.seen[static_cast<std::size_t>(share.component)].from.id : sight.birth;
    }
}

}  // namespace

double PhdMap::update(const Settings& settings, const Vector3& pose, bool, const ParticleScan&, Work& work,
                      std::vector<SightRecord>& records) {
    const PhdMapParameters& p = settings.parameters;
    double log_likelihood = 0;
    work.fresh.clear();
    bool found = (pose.head<2>() - work.centre).norm() + work.scan.reach <= work.radius;
    for (int v = 0; v < static_cast<int>(work.scan.views.size()); ++v) {
        if (!work.scan.views[static_cast<std::size_t>(v)].looks) continue;
        if (!found) findNear(pose.head<2>(), work.scan.reach, work);
        found = false;  // the next sensor looks at what this one has made of the map
        correct(settings, pose, v, work);
        log_likelihood += logLikelihood(settings, pose, v, work);
        begin(settings, pose, v, work);
        recordTentative(v, work, records);
        mergeTerms(work.terms, p.prune_below, p.merge_within, work.merged);
        write(settings, pose, v, work);
    }
    // Births join at the next step. Their numbers lie above all there are.
    std::sort(work.fresh.begin(), work.fresh.end(),
              [](const PhdFeature& a, const PhdFeature& b) { return a.id < b.id; });
    for (const PhdFeature& feature : work.fresh) features_.append(feature);
    leaveBehind(settings, pose.head<2>(), work);
    return log_likelihood;
}

/// Eq. 23 to 29: every component with every detection, and as not detected.
void PhdMap::correct(const Settings& settings, const Vector3& pose, int view, Work& work) {
    const PhdMapParameters& p = settings.parameters;
    const PhdView& window = work.scan.views[static_cast<std::size_t>(view)];
    const SensorPlace place = placeOf(pose, window.sensor);
    const SensorFrame frame(place);
    work.seen.clear();
    work.terms.clear();
    for (std::size_t s = 0; s < work.shares.size(); ++s) {
        const PhdSight& sight = work.scan.sights[s];
        if (sight.view != view) continue;
        work.shares[s] = {};
        work.shares[s].all = sight.clutter;
    }
    for (const Near& near : work.near) {
        const Vector2 at = frame(near.point.mean);
        if (!window.maySee(at)) continue;
        const int component = static_cast<int>(work.seen.size());
        // The margin is there for landmarks, which are dear. What is none yet has no right to it: clutter
        // would live on.
        work.seen.push_back({near, near.weight <= p.landmark_above || window.surelySees(at)});
        bool looked = false;
        PointSight expected;
        for (std::size_t s = 0; s < work.shares.size(); ++s) {
            const PhdSight& sight = work.scan.sights[s];
            const double variance = sight.variance + near.point.covariance.trace();
            if (sight.view != view || !mayBelong(sight, at, near.weight, variance)) continue;
            if (!looked) expected = sightOf(near.point, place, settings.transform);
            looked = true;
            const PointInnovation innovation(expected, sight.z, sight.R);
            const double value = detectionTerm(settings, near.weight, innovation);
            if (value < p.prune_below * sight.clutter) continue;
            PhdTerm term{component, static_cast<int>(s), value, near.point};
            slamot::update(term.point, expected, innovation);
            work.terms.push_back(term);
            work.shares[s].all += value;
        }
    }
    for (PhdTerm& term : work.terms) {
        Share& share = work.shares[static_cast<std::size_t>(term.sight)];
        term.weight /= share.all;
        share.explained += term.weight;
        work.seenOf(term).detected += term.weight;
        if (term.weight <= share.largest) continue;
        share.largest = term.weight;
        share.component = term.component;
    }
    for (std::size_t i = 0; i < work.seen.size(); ++i) {
        const Seen& seen = work.seen[i];
        const double all = seen.from.weight, missed = (1 - p.detection_probability) * all;
        // Where a miss says nothing, what was detected is still there once only.
        const double rest = seen.surely ? missed : std::max(missed, all - seen.detected);
        work.terms.push_back({static_cast<int>(i), -1, rest, seen.from.point});
    }
}

void PhdMap::leaveBehind(const Settings& settings, const Vector2& position, Work& work) {
    work.lost.clear();
    features_.sweep(work.lost, [&](const PhdFeature& feature) {
        return feature.weight < settings.parameters.leave_below &&
               (feature.point.mean - position).squaredNorm() > work.scan.reach * work.scan.reach;
    });
    features_.remove(work.lost);
}

}  // namespace slamot

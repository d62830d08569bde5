#include "slamot/core/particles/PhdMap.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "slamot/core/particles/MixedEstimate.h"

namespace slamot {
namespace {

/// [m] that a pose drawn lies from its prediction as a rule: components so much farther off are looked up with the rest.
constexpr double draw_margin = 1.0;

/// How much farther apart than their covariances alone allow a pair may be on the plane and still be looked at:
/// a gate in range and bearing is bent there.
constexpr double bend = 4.0;

/// The world in a sensor's frame.
class SensorFrame {
  public:
    explicit SensorFrame(const SensorPlace& place) : R_(rotation(place.heading)), origin_(place.position) {}
    Vector2 operator()(const Vector2& point) const { return R_.transpose() * (point - origin_); }

  private:
    Matrix2 R_;
    Vector2 origin_;
};

/// Cheap: false for pairs that could only make a term too light to be kept. `variance`: of the two, on the plane.
bool mayBelong(const PhdSight& sight, const Vector2& at, double weight, double variance) {
    const double widest = sight.widest + (weight > PhdSight::ordinary_weight ? 2 * std::log(weight) : 0);
    return (at - sight.point).squaredNorm() <= bend * widest * variance;
}

int holderOf(const PhdGroup& group, PhdMap::Work& work) {
    for (int k = group.first; k < group.last; ++k) {
        const int component = work.terms[static_cast<std::size_t>(work.merged.order[static_cast<std::size_t>(k)])].component;
        PhdMap::Seen& seen = work.seen[static_cast<std::size_t>(component)];
        if (seen.kept) continue;
        seen.kept = true;
        return component;
    }
    return -1;
}

/// A sight of the view whose number is not given away yet; -1: there is none.
int numberFor(const PhdGroup& group, int view, PhdMap::Work& work) {
    const auto take = [&](int s) {
        if (s < 0 || work.scan.sights[static_cast<std::size_t>(s)].view != view) return false;
        PhdMap::Share& share = work.shares[static_cast<std::size_t>(s)];
        return !std::exchange(share.numbered, true);
    };
    for (int k = group.first; k < group.last; ++k) {
        const int s = work.terms[static_cast<std::size_t>(work.merged.order[static_cast<std::size_t>(k)])].sight;
        if (take(s)) return s;
    }
    for (int s = 0; s < static_cast<int>(work.shares.size()); ++s)
        if (take(s)) return s;
    return -1;
}

/// The paper's: what has been extracted goes through the filter of features with its detection again.
void correctAgain(const PhdMap::Settings& settings, const Vector3& pose, const PhdGroup& group, const PhdMap::Work& work,
                  PhdFeature& feature) {
    const int s = work.terms[static_cast<std::size_t>(work.merged.order[static_cast<std::size_t>(group.first)])].sight;
    if (s < 0 || !PhdMap::isConfirmed(settings, feature)) return;
    const PhdSight& sight = work.scan.sights[static_cast<std::size_t>(s)];
    const PointSight expected = sightOf(
        feature.point, placeOf(pose, work.scan.views[static_cast<std::size_t>(sight.view)].sensor), settings.transform);
    update(feature.point, expected, PointInnovation(expected, sight.z, sight.R));
}

}  // namespace

PhdMap::Settings::Settings(const PhdMapParameters& p, GaussianTransform t)
    : parameters(p),
      transform(t),
      log_detection(std::log(p.detection_probability)),
      log_least(std::log(p.prune_below)),
      birth_weight(p.birthWeight()) {}

// --- which landmark is behind which sight --------------------------------------------------------------------

void PhdMap::pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work,
                    std::vector<SightRecord>& records) const {
    if (work.of != &scan) {
        work.scan = PhdScan(scan, settings.parameters, settings.transform);
        work.of = &scan;
    }
    findNear(pose.mean.head<2>(), work.scan.reach + draw_margin, work);
    const std::size_t sights = work.scan.sights.size();
    work.pairs.assign(sights, {});
    records.assign(sights, {});
    work.shares.resize(sights);
    for (std::size_t s = 0; s < sights; ++s) work.shares[s].all = work.scan.sights[s].clutter;

    // Of each sight the likeliest landmark, and the sum over all components.
    const double place_variance = pose.factor.topRows<2>().squaredNorm();
    const double turn_variance = pose.factor.row(2).squaredNorm();
    for (std::size_t v = 0; v < work.scan.views.size(); ++v) {
        const SensorFrame frame(placeOf(pose.mean, work.scan.views[v].sensor));
        for (std::size_t n = 0; n < work.near.size(); ++n) {
            const Near& near = work.near[n];
            const Vector2 at = frame(near.point.mean);
            const double variance = place_variance + near.point.covariance.trace();
            bool looked = false;
            PointSight expected;
            for (std::size_t s = 0; s < sights; ++s) {
                const PhdSight& sight = work.scan.sights[s];
                if (sight.view != static_cast<int>(v)) continue;
                const double spread = variance + sight.variance + sight.z.x() * sight.z.x() * turn_variance;
                if (!mayBelong(sight, at, near.weight, spread)) continue;
                // The pairs are for the proposal, which corrects itself: the Jacobian does.
                if (!looked) expected = sightOf(near.point, pose, work.scan.views[v].sensor, GaussianTransform::linear);
                looked = true;
                const PointInnovation innovation(expected, sight.z, sight.R);
                const double value =
                    std::exp(settings.log_detection + innovation.logLikelihood()) * near.weight;
                work.shares[s].all += value;
                Pair& pair = work.pairs[s];
                if (near.weight > settings.parameters.landmark_above && value > pair.responsibility)
                    pair = {static_cast<int>(n), value, expected.z, innovation.S};
            }
        }
    }
    // One detection for each landmark, the one it explains best.
    for (std::size_t s = 0; s < sights; ++s) {
        Pair& pair = work.pairs[s];
        pair.responsibility /= work.shares[s].all;
        if (pair.responsibility <= 0.5) pair.near = -1;
        for (std::size_t other = 0; other < s && pair.near >= 0; ++other) {
            if (work.pairs[other].near != pair.near) continue;
            (work.pairs[other].responsibility < pair.responsibility ? work.pairs[other] : pair).near = -1;
        }
    }
    for (std::size_t s = 0; s < sights; ++s) {
        const Pair& pair = work.pairs[s];
        if (pair.near < 0) continue;
        records[s].landmark = work.near[static_cast<std::size_t>(pair.near)].id;
        records[s].outcome = Outcome::updated;
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

void PhdMap::refine(const Settings& settings, const ParticleScan& scan, const Work& work, RefinedPose& pose) const {
    for (std::size_t s = 0; s < work.pairs.size(); ++s) {
        if (work.pairs[s].near < 0) continue;
        const GaussianPoint& point = work.near[static_cast<std::size_t>(work.pairs[s].near)].point;
        const ScanSight& sight = scan.sights[s];
        const PointSight expected = sightOf(point, pose.belief(), scan.sensorOf(sight), settings.transform);
        pose.take(expected, PointInnovation(expected, sight.z, sight.R));
    }
}

// --- the density's update ------------------------------------------------------------------------------------

namespace {

/// Of the landmark alone that is known best in view: (1 - P_D + P_D sum_z N(z; h(m), R) / c) v-(m) / v(m), with the
/// density's values before and after. 0 when there is none.
double logSingle(const PhdMap::Settings& settings, const Vector3& pose, int view, const PhdMap::Work& work) {
    const PhdMap::Seen* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const PhdMap::Seen& seen : work.seen) {
        const double size = seen.from.point.covariance.determinant();
        if (!seen.surely || seen.from.weight <= settings.parameters.landmark_above || size >= least) continue;
        least = size;
        best = &seen;
    }
    if (!best) return 0;
    const Vector2 m = best->from.point.mean;
    double before = 0, after = 0;
    for (const PhdMap::Seen& seen : work.seen) before += seen.from.weight * densityAt(m, seen.from.point);
    for (const PhdTerm& term : work.terms) after += term.weight * densityAt(m, term.point);
    const PointSight exact = sightOf(
        {m, Matrix2::Zero()}, placeOf(pose, work.scan.views[static_cast<std::size_t>(view)].sensor), GaussianTransform::linear);
    double ratio = 1 - settings.parameters.detection_probability;
    for (const PhdSight& sight : work.scan.sights)
        if (sight.view == view)
            ratio += std::exp(settings.log_detection + PointInnovation(exact, sight.z, sight.R).logLikelihood() -
                              sight.log_clutter);
    return std::log(ratio * before / after);
}

/// Without what is the same for all particles.
double logLikelihood(const PhdMap::Settings& settings, const Vector3& pose, int view, const PhdMap::Work& work) {
    double out = 0;
    if (settings.parameters.likelihood == PhdLikelihood::set) {
        for (std::size_t s = 0; s < work.scan.sights.size(); ++s)
            if (work.scan.sights[s].view == view) out += std::log(work.shares[s].all);
        for (const PhdMap::Seen& seen : work.seen)
            if (seen.surely) out -= settings.parameters.detection_probability * seen.from.weight;
        return out;
    }
    for (const PhdTerm& term : work.terms) out += term.weight;
    for (const PhdMap::Seen& seen : work.seen) out -= seen.from.weight;
    if (settings.parameters.likelihood == PhdLikelihood::single_feature) out += logSingle(settings, pose, view, work);
    return out;
}

}  // namespace

double PhdMap::update(const Settings& settings, const Vector3& pose, bool, const ParticleScan& scan, Work& work,
                      std::vector<SightRecord>& records) {
    double log_likelihood = 0;
    work.fresh.clear();
    bool found = (pose.head<2>() - work.centre).norm() + work.scan.reach <= work.radius;
    for (int v = 0; v < static_cast<int>(scan.views.size()); ++v) {
        if (!work.scan.views[static_cast<std::size_t>(v)].looks) continue;
        if (!found) findNear(pose.head<2>(), work.scan.reach, work);
        correct(settings, pose, v, work);
        log_likelihood += logLikelihood(settings, pose, v, work);
        for (std::size_t s = 0; s < records.size(); ++s) {
            if (work.scan.sights[s].view != v || records[s].outcome == Outcome::updated) continue;
            const Share& share = work.shares[s];
            records[s].outcome = Outcome::tentative;
            records[s].landmark = share.explained < 0.5 || share.component < 0
                                      ? work.scan.sights[s].birth
                                      : work.seen[static_cast<std::size_t>(share.component)].from.id;
        }
        begin(settings, pose, v, work);
        mergeTerms(work.terms, settings.parameters.prune_below, settings.parameters.merge_within, work.merged);
        write(settings, pose, v, work);
        found = false;
    }
    // Births join at the next step. Their numbers lie above all there are.
    std::sort(work.fresh.begin(), work.fresh.end(),
              [](const PhdFeature& a, const PhdFeature& b) { return a.id < b.id; });
    for (const PhdFeature& feature : work.fresh) features_.append(feature);
    leaveBehind(settings, pose.head<2>(), work);
    return log_likelihood;
}

/// Eq. 23 to 29: every component as not detected, and with every detection.
void PhdMap::correct(const Settings& settings, const Vector3& pose, int view, Work& work) const {
    const PhdMapParameters& p = settings.parameters;
    const PhdView& window = work.scan.views[static_cast<std::size_t>(view)];
    const std::vector<PhdSight>& sights = work.scan.sights;
    const SensorPlace place = placeOf(pose, window.sensor);
    const SensorFrame frame(place);
    work.seen.clear();
    work.terms.clear();
    for (std::size_t s = 0; s < sights.size(); ++s)
        if (sights[s].view == view) work.shares[s] = {sights[s].clutter, 0, 0, -1, false};

    for (const Near& near : work.near) {
        const Vector2 at = frame(near.point.mean);
        if (!window.maySee(at)) continue;
        const int component = static_cast<int>(work.seen.size());
        work.seen.push_back({near, near.weight <= p.landmark_above || window.surelySees(at)});
        bool looked = false;
        PointSight expected;
        for (std::size_t s = 0; s < sights.size(); ++s) {
            const PhdSight& sight = sights[s];
            if (sight.view != view ||
                !mayBelong(sight, at, near.weight, sight.variance + near.point.covariance.trace()))
                continue;
            if (!looked) expected = sightOf(near.point, place, settings.transform);
            looked = true;
            const PointInnovation innovation(expected, sight.z, sight.R);
            const double weight = std::exp(settings.log_detection + innovation.logLikelihood()) * near.weight;
            if (weight < p.prune_below * sight.clutter) continue;
            PhdTerm term{component, static_cast<int>(s), weight, near.point};
            slamot::update(term.point, expected, innovation);
            work.terms.push_back(term);
            work.shares[s].all += weight;
        }
    }
    for (PhdTerm& term : work.terms) {
        Share& share = work.shares[static_cast<std::size_t>(term.sight)];
        term.weight /= share.all;
        share.explained += term.weight;
        if (term.weight > share.largest) {
            share.largest = term.weight;
            share.component = term.component;
        }
        work.seen[static_cast<std::size_t>(term.component)].detected += term.weight;
    }
    for (std::size_t i = 0; i < work.seen.size(); ++i) {
        const Seen& seen = work.seen[i];
        const double w = seen.from.weight, missed = (1 - p.detection_probability) * w;
        work.terms.push_back({static_cast<int>(i), -1, seen.surely ? missed : std::max(missed, w - seen.detected),
                              seen.from.point});
    }
}

/// What no component explains starts one.
void PhdMap::begin(const Settings& settings, const Vector3& pose, int view, Work& work) const {
    const Matrix2 R = rotation(pose.z());
    for (std::size_t s = 0; s < work.shares.size(); ++s) {
        const PhdSight& sight = work.scan.sights[s];
        if (sight.view != view) continue;
        if (settings.parameters.births == PhdBirths::unexplained && work.shares[s].explained >= 0.5) continue;
        work.shares[s].numbered = true;
        PhdFeature feature;
        feature.id = sight.birth;
        feature.point = {pose.head<2>() + R * sight.first.mean, R * sight.first.covariance * R.transpose()};
        feature.weight = settings.birth_weight;
        feature.first_seen = feature.last_seen = work.scan.now;
        work.fresh.push_back(feature);
    }
}

/// A group goes on in the place, and under the number, of its heaviest member whose place is still free. Splits that
/// find none take the number of a detection that starts nothing else, one of their own if there is one, since they too
/// are what else it may have been of. Where no number is left either they join what has their heaviest member's place.
void PhdMap::write(const Settings& settings, const Vector3& pose, int view, Work& work) {
    for (const PhdGroup& group : work.merged.groups) {
        const int holder = holderOf(group, work);
        if (holder >= 0) {
            const Seen& seen = work.seen[static_cast<std::size_t>(holder)];
            if (group.weight == seen.from.weight && group.detected == 0) continue;
            PhdFeature& feature = features_.write(seen.from.place);
            feature.weight = group.weight;
            feature.point = group.point;
            if (group.detected > 0.5 * group.weight) {
                ++feature.seen;
                feature.last_seen = work.scan.now;
            }
            if (settings.parameters.correction == PhdCorrection::twice) correctAgain(settings, pose, group, work, feature);
            features_.moved(seen.from.place);
        } else if (const int sight = numberFor(group, view, work); sight >= 0) {
            PhdFeature feature;
            feature.id = work.scan.sights[static_cast<std::size_t>(sight)].birth;
            feature.weight = group.weight;
            feature.point = group.point;
            feature.first_seen = feature.last_seen = work.scan.now;
            work.fresh.push_back(feature);
        } else {
            const PhdTerm& heaviest = work.terms[static_cast<std::size_t>(work.merged.order[group.first])];
            const Place place = work.seen[static_cast<std::size_t>(heaviest.component)].from.place;
            PhdFeature& feature = features_.write(place);
            FeatureMixture both;
            both.add(feature.weight, feature.point);
            both.add(group.weight, group.point);
            feature.weight += group.weight;
            feature.point = both.moments();
            features_.moved(place);
        }
    }
    work.lost.clear();
    for (const Seen& seen : work.seen)
        if (!seen.kept) work.lost.push_back(seen.from.place);
    features_.remove(work.lost);
}

/// Of what was left behind nothing is missed: one page a scan is looked through for what is light there.
void PhdMap::leaveBehind(const Settings& settings, const Vector2& position, Work& work) {
    if (++swept_ >= features_.pages()) swept_ = 0;
    work.lost.clear();
    features_.forEachOfPage(swept_, [&](Place place, const PhdFeature& feature) {
        if (feature.weight < settings.parameters.leave_below &&
            (feature.point.mean - position).squaredNorm() > work.scan.reach * work.scan.reach)
            work.lost.push_back(place);
    });
    features_.remove(work.lost);
}

}  // namespace slamot

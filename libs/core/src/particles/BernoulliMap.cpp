#include "slamot/core/particles/BernoulliMap.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/association/AssociationMarginals.h"
#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/association/DetectionModel.h"
#include "slamot/core/objects/FieldOfView.h"
#include "slamot/core/particles/StandingSensor.h"

namespace slamot {
namespace {

/// Pairs less likely than this are left out of the mixture: they would move nothing.
constexpr double least_pair = 1e-8;

constexpr double least_clutter = 1e-6;

/// Log of how much likelier it is that a detection is of a feature than that it is unexplained and the
/// feature missed.
double logRatio(const BernoulliMap::Work::Near& near, const Candidate& pair, double unexplained) {
    const double visible = near.existence.visibility();
    return std::log(near.detection * visible / (unexplained * (1 - near.miss() * visible))) +
           pair.log_likelihood;
}

}  // namespace

BernoulliMap::Settings::Settings(const BernoulliMapParameters& p, GaussianTransform t)
    : parameters(p),
      transform(t),
      gate(chiSquareQuantile(p.gate_probability, 2)),
      rival_gate(chiSquareQuantile(0.999, 2)),
      merge_odds(std::log(p.merge_probability) - std::log1p(-p.merge_probability)) {}

// --- which detection may be of what
// ---------------------------------------------------------------------------------------------------

void BernoulliMap::findNear(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                            int number, Work& work) const {
    const LifeParameters& life = settings.parameters.life;
    const ScanView& view = scan.views[static_cast<std::size_t>(number)];
    work.near.clear();
    work.view = number;
    const StandingSensor sensor(pose, view);
    features_.forEachNear(
        sensor.position(), sensor.reach(), [&](Place place, const BernoulliFeature& feature) {
            // What has a name is known by it alone, and says nothing when it is not named.
            if (feature.source.valid() || !sensor.mayShow(feature.point) || work.isLost(place)) return;
            work.near.push_back(
                {place, feature.point, feature.existence, 0, sensor.sightOf(feature.point), false});
            Work::Near& near = work.near.back();
            near.detection = life.detection_probability * std::max(sensor.inView(near.sight), least_in_view);
            near.existence.pass(secondsBetween(feature.looked, scan.now), life);
        });
}

void BernoulliMap::expectUnexplained(const Settings& settings, const PoseBelief& pose,
                                     const ParticleScan& scan, Work& work) const {
    const BernoulliMapParameters& p = settings.parameters;
    const ScanView& view = scan.views[static_cast<std::size_t>(work.view)];
    const StandingSensor sensor(pose, view);
    const double clutter = clutterDensity(std::max(p.life.clutter_per_scan, least_clutter), view.sensor);
    const double appearing = clutterDensity(p.life.new_per_scan, view.sensor);
    work.fresh.resize(scan.sights.size());
    work.unexplained.resize(scan.sights.size());
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (sight.view != work.view || sight.named()) continue;
        // An element of range and bearing at range r covers r times as much ground.
        work.fresh[s] = p.life.detection_probability * p.density * undetected_.part(sensor.pointOf(sight.z)) *
                            sight.z.x() +
                        appearing;
        work.unexplained[s] = work.fresh[s] + clutter;
    }
}

void BernoulliMap::findCandidates(const Settings& settings, const ParticleScan& scan, Work& work) {
    work.candidates.clear();
    work.log_ratios.clear();
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (sight.view != work.view || sight.named()) continue;
        for (std::size_t n = 0; n < work.near.size(); ++n) {
            const Work::Near& near = work.near[n];
            // Most fail here.
            const double farther = sight.z.x() - near.sight.z.x();
            if (farther * farther > settings.gate * (near.sight.covariance(0, 0) + sight.R(0, 0))) continue;
            const PointInnovation innovation(near.sight, sight.z, sight.R);
            if (innovation.nis > settings.gate || !(near.existence.visibility() > 0)) continue;
            work.candidates.push_back(
                {static_cast<int>(s), static_cast<int>(n), innovation.nis, innovation.logLikelihood()});
            work.log_ratios.push_back(logRatio(near, work.candidates.back(), work.unexplained[s]));
        }
    }
}

void BernoulliMap::lookAgain(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                             Work& work) {
    for (std::size_t c = 0; c < work.candidates.size(); ++c) {
        Candidate& pair = work.candidates[c];
        const ScanSight& sight = scan.sights[static_cast<std::size_t>(pair.detection)];
        Work::Near& near = work.near[static_cast<std::size_t>(pair.object)];
        if (!near.at_pose)
            near.sight = sightOf(near.point, placeOf(pose, scan.sensorOf(sight)), settings.transform);
        near.at_pose = true;
        const PointInnovation innovation(near.sight, sight.z, sight.R);
        pair.nis = innovation.nis;
        pair.log_likelihood = innovation.logLikelihood();
        work.log_ratios[c] = logRatio(near, pair, work.unexplained[static_cast<std::size_t>(pair.detection)]);
    }
}

void BernoulliMap::pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                          Work& work, std::vector<SightRecord>& records) const {
    work.pairs.clear();
    work.lost.clear();
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
        work.pairs.push_back({static_cast<int>(s), feature->point});
        tell(s, feature->id, sightOf(feature->point, pose, scan.sensorOf(sight), settings.transform));
    }
    for (int view = 0; view < static_cast<int>(scan.views.size()); ++view) {
        if (!scan.views[static_cast<std::size_t>(view)].nameless) continue;
        findNear(settings, pose, scan, view, work);
        expectUnexplained(settings, pose, scan, work);
        findCandidates(settings, scan, work);
        const AssociationProblem problem(static_cast<int>(scan.sights.size()),
                                         static_cast<int>(work.near.size()), work.candidates);
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
                work.pairs.push_back({static_cast<int>(s), near.point});
        }
    }
}

void BernoulliMap::refine(const Settings& settings, const ParticleScan& scan, const Work& work,
                          RefinedPose& pose) const {
    for (const Work::Pair& pair : work.pairs) {
        const ScanSight& sight = scan.sights[static_cast<std::size_t>(pair.sight)];
        const PointSight expected =
            sightOf(pair.point, pose.belief(), scan.sensorOf(sight), settings.transform);
        pose.take(expected, PointInnovation(expected, sight.z, sight.R));
    }
}

// --- what the scan says of the map
// ---------------------------------------------------------------------------------------------------

double BernoulliMap::update(const Settings& settings, const Vector3& pose, bool drawn,
                            const ParticleScan& scan, Work& work, std::vector<SightRecord>& records) {
    double log_likelihood = 0;
    std::vector<double> none(scan.sights.size());
    work.lost.clear();
    for (int view = 0; view < static_cast<int>(scan.views.size()); ++view) {
        log_likelihood += updateNamed(settings, pose, scan, view, records);
        if (scan.views[static_cast<std::size_t>(view)].nameless)
            log_likelihood += updateNameless(settings, pose, drawn, scan, view, work, records, none);
        for (std::size_t s = 0; s < scan.sights.size(); ++s) {
            const ScanSight& sight = scan.sights[s];
            if (sight.view != view) continue;
            // Less than what is let go is not started, nor what is not expected.
            const bool starts =
                sight.named() ? !sight.known_as.valid()
                              : none[s] >= settings.parameters.life.remove_probability && work.fresh[s] > 0;
            if (!starts) continue;
            start(settings, pose, scan, sight,
                  sight.named() ? 1 : none[s] * work.fresh[s] / work.unexplained[s]);
            if (records[s].landmark.valid()) continue;
            records[s].landmark = sight.birth;
            records[s].outcome = sight.named() ? Outcome::initiated : Outcome::tentative;
        }
    }
    if (scan.nameless) letGo(settings, scan.now, work);
    return log_likelihood;
}

double BernoulliMap::updateNamed(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                                 int view, std::vector<SightRecord>& records) {
    double log_likelihood = 0;
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        Place place;
        if (sight.view != view || !sight.known_as.valid() || !features_.locate(sight.known_as, place))
            continue;
        BernoulliFeature& feature = features_.write(place);
        const PointSight expected =
            sightOf(feature.point, placeOf(pose, scan.sensorOf(sight)), settings.transform);
        const PointInnovation innovation(expected, sight.z, sight.R);
        slamot::update(feature.point, expected, innovation);
        features_.moved(place);
        ++feature.seen;
        feature.last_seen = scan.now;
        records[s].outcome = Outcome::updated;
        log_likelihood += innovation.logLikelihood();
    }
    return log_likelihood;
}

double BernoulliMap::updateNameless(const Settings& settings, const Vector3& pose, bool drawn,
                                    const ParticleScan& scan, int view, Work& work,
                                    std::vector<SightRecord>& records, std::vector<double>& none) {
    // Pairs were found at another pose; and another sensor may see what the one before has started.
    const PoseBelief at{pose, Matrix3::Zero()};
    if (drawn || scan.views.size() > 1) {
        findNear(settings, at, scan, view, work);
        expectUnexplained(settings, at, scan, work);
        findCandidates(settings, scan, work);
    }
    lookAgain(settings, pose, scan, work);
    const AssociationProblem problem(static_cast<int>(scan.sights.size()), static_cast<int>(work.near.size()),
                                     work.candidates);
    const AssociationMarginals marginals =
        associationMarginals(problem, work.log_ratios, settings.parameters.state_budget);

    double log_likelihood = marginals.log_sum;
    for (const Work::Near& near : work.near)
        log_likelihood += std::log1p(-near.miss() * near.existence.visibility());
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (sight.view != view || sight.named()) continue;
        log_likelihood += std::log(work.unexplained[s]);
        none[s] = marginals.none[s];
    }
    const StandingSensor sensor(at, scan.views[static_cast<std::size_t>(view)]);
    const double miss = 1 - settings.parameters.life.detection_probability;
    log_likelihood -=
        settings.parameters.density *
        undetected_.look(sensor.position(), scan.views[static_cast<std::size_t>(view)].sensor.max_range,
                         [&](const Vector2& centre) { return sensor.covers(centre) ? miss : 1; });
    work.mixtures.assign(work.near.size(), {});
    for (int c = 0; c < problem.candidates(); ++c) {
        const double p = marginals.pair[static_cast<std::size_t>(c)];
        if (p < least_pair) continue;
        const auto s = static_cast<std::size_t>(problem.candidate(c).detection);
        const ScanSight& sight = scan.sights[s];
        const auto n = static_cast<std::size_t>(problem.candidate(c).object);
        const Work::Near& near = work.near[n];
        GaussianPoint point = near.point;
        slamot::update(point, near.sight, PointInnovation(near.sight, sight.z, sight.R));
        work.mixtures[n].add(p, point);
        const BernoulliFeature& feature = features_.at(near.place);
        if (records[s].landmark == feature.id)
            records[s].outcome = isConfirmed(settings, feature) ? Outcome::updated : Outcome::tentative;
    }
    for (std::size_t n = 0; n < work.near.size(); ++n) take(scan.now, marginals.missed[n], n, work);
    findRivals(settings, problem, work);
    weighRivals(settings, pose, scan, marginals, work);
    for (const Work::Near& near : work.near)
        if (features_.at(near.place).existence.lost(settings.parameters.life))
            work.lost.push_back(near.place);
    return log_likelihood;
}

void BernoulliMap::take(Stamp now, double missed, std::size_t n, const Work& work) {
    const Work::Near& near = work.near[n];
    BernoulliFeature& feature = features_.write(near.place);
    feature.existence = near.existence;
    feature.existence.detectedPerhaps(1 - missed, near.miss());
    feature.looked = now;
    if (missed < 1 - 100 * least_pair) {
        const double seen = near.miss() * near.existence.visibility();
        const double there = missed * (near.existence.probability() - seen) / (1 - seen);
        FeatureMixture mixture = work.mixtures[n];
        if (there > 100 * least_pair) mixture.add(there, near.point);
        feature.point = mixture.moments();
        features_.moved(near.place);
    }
    if (missed < 0.5) {
        ++feature.seen;
        feature.last_seen = now;
    }
}

// --- what comes and goes
// ---------------------------------------------------------------------------------------------------

void BernoulliMap::start(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                         const ScanSight& sight, double existence) {
    BernoulliFeature feature;
    feature.id = sight.birth;
    feature.point = firstSight(placeOf(pose, scan.sensorOf(sight)), sight.z, sight.R, settings.transform);
    feature.source = sight.source;
    if (!sight.named()) {
        feature.existence = Existence::atFirstSight(existence);
    }
    feature.first_seen = feature.last_seen = feature.looked = scan.now;
    features_.append(feature);
}

void BernoulliMap::letGo(const Settings& settings, Stamp now, Work& work) {
    features_.sweep(work.lost, [&](const BernoulliFeature& feature) {
        return !isConfirmed(settings, feature) &&
               secondsBetween(feature.last_seen, now) > settings.parameters.max_unseen;
    });
    features_.remove(work.lost);
}

std::vector<ParameterTable> describe(BernoulliMapParameters& p, const std::string& name) {
    ParameterTable association(name + ".association",
                               "Which detection is of which landmark, in each particle.");
    association
        .choice("landmarks", p.use_nameless, {{"marginal", true}, {"known", false}},
                "For detections without identity. marginal: of each landmark with its probability over all "
                "pairings; "
                "known: they are ignored.")
        .real("gate_probability", p.gate_probability, "-", Interval::openProbability(),
              "Part of a landmark's detections that lie inside its gate.")
        .real("pose_probability", p.pose_probability, "-", Interval::between(0.5, 1),
              "A landmark refines the pose where its detection comes from it with this probability at least.")
        .integer(
            "state_budget", p.state_budget, Interval::between(1, 1000000),
            "States of the exact sums over pairings at most; beyond, belief propagation approximates them.");
    ParameterTable landmarks(name + ".landmarks", "Life of landmarks without an identity.");
    landmarks.real("density", p.density, "1/m^2", Interval::nonNegative(),
                   "Landmarks to be expected where no sensor has looked yet.");
    describe(p.life, "landmarks", landmarks);
    landmarks.real("merge_probability", p.merge_probability, "-", Interval::openProbability(),
                   "Of two landmarks being one, at which they are merged.");
    landmarks.real("max_unseen", p.max_unseen, "s", Interval::positiveOrInfinite(),
                   "A landmark that is not confirmed and not seen for longer is let go.");
    return {association, landmarks};
}

}  // namespace slamot

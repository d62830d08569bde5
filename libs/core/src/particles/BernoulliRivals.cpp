// Features of a Bernoulli map that may be one.
#include <algorithm>
#include <cmath>
#include <optional>

#include "slamot/core/association/AssociationMarginals.h"
#include "slamot/core/particles/BernoulliMap.h"

namespace slamot {
namespace {

/// A single scan does not say more than this: it is by far not the only thing that may be wrong then.
constexpr double most_of_a_scan = 5;

/// Part of a detection that must be theirs for a look to count.
constexpr double least_seen = 0.5;

}  // namespace

void BernoulliMap::findRivals(const Settings& settings, const AssociationProblem& problem, const Work& work) {
    const auto fits = [&](int c) { return problem.candidate(c).nis <= settings.rival_gate; };
    for (int s = 0; s < problem.detections(); ++s) {
        // Features are numbered as they came: the first that fits is the oldest.
        int oldest = problem.first(s);
        while (oldest < problem.first(s + 1) && !fits(oldest)) ++oldest;
        for (int c = oldest + 1; c < problem.first(s + 1); ++c) {
            if (!fits(c)) continue;
            const auto placeOf = [&](int k) {
                return work.near[static_cast<std::size_t>(problem.candidate(k).object)].place;
            };
            const BernoulliFeature &older = features_.at(placeOf(oldest)),
                                   &younger = features_.at(placeOf(c));
            // Two neighbours that are two for sure leave the younger open to what else it may be.
            const bool is_taken = younger.rival.valid() && find(younger.rival) &&
                                  (younger.rival == older.id || younger.same > -settings.merge_odds);
            if (younger.source.valid() || is_taken) continue;
            const LandmarkId rival = older.id;  // writing may move what is read
            BernoulliFeature& written = features_.write(placeOf(c));
            written.rival = rival;
            written.same = 0;
        }
    }
}

void BernoulliMap::weighRivals(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                               const AssociationMarginals& marginals, Work& work) {
    for (std::size_t n = 0; n < work.near.size(); ++n) {
        const LandmarkId rival = features_.at(work.near[n].place).rival;
        if (!rival.valid()) continue;
        const auto older = std::find_if(work.near.begin(), work.near.end(), [&](const Work::Near& near) {
            return features_.at(near.place).id == rival;
        });
        if (older == work.near.end() || work.isLost(older->place)) continue;
        const double look = logSame(settings, pose, scan, marginals,
                                    static_cast<int>(older - work.near.begin()), static_cast<int>(n), work);
        if (look == 0) continue;
        BernoulliFeature& younger = features_.write(work.near[n].place);
        younger.same =
            std::max(younger.same + std::clamp(look, -most_of_a_scan, most_of_a_scan), -settings.merge_odds);
        if (younger.same < settings.merge_odds) continue;
        merge(older->place, work.near[n].place);
        work.lost.push_back(work.near[n].place);
    }
}

double BernoulliMap::logSame(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                             const AssociationMarginals& marginals, int older, int younger,
                             Work& work) const {
    const Work::Near& a = work.near[static_cast<std::size_t>(older)];
    const Work::Near& b = work.near[static_cast<std::size_t>(younger)];
    const SensorPlace sensor = placeOf(pose, scan.views[static_cast<std::size_t>(work.view)].sensor.pose);
    // What is there may be hidden.
    const auto detectionOf = [](const Work::Near& near) {
        return near.detection * near.existence.visibility() / near.existence.probability();
    };
    const double detected_a = detectionOf(a), detected_b = detectionOf(b);
    std::optional<PointSight> both;
    double theirs = 0;
    bool shared = false;
    work.rival_sights.clear();
    for (std::size_t c = 0; c < work.candidates.size();) {
        const int s = work.candidates[c].detection;
        const ScanSight& sight = scan.sights[static_cast<std::size_t>(s)];
        RivalSight weights{0, 0, 0};
        double of_others = 0;
        int fits = 0;
        for (; c < work.candidates.size() && work.candidates[c].detection == s; ++c) {
            const Candidate& pair = work.candidates[c];
            if (pair.object != older && pair.object != younger) {
                of_others += marginals.pair[c];
                continue;
            }
            theirs += marginals.pair[c];
            fits += pair.nis <= settings.rival_gate;
            (pair.object == older ? weights.first : weights.second) =
                (pair.object == older ? detected_a : detected_b) * std::exp(pair.log_likelihood);
        }
        if (weights.first + weights.second == 0) continue;
        shared = shared || fits == 2;
        if (!both) both = sightOf(fused(a.point, b.point), sensor, GaussianTransform::linear);
        weights.one = std::max(detected_a, detected_b) *
                      std::exp(PointInnovation(*both, sight.z, sight.R).logLikelihood());
        const double none = std::max(marginals.none[static_cast<std::size_t>(s)], 1e-12);
        const double else_ = work.unexplained[static_cast<std::size_t>(s)] * (1 + of_others / none);
        work.rival_sights.push_back({weights.first / else_, weights.second / else_, weights.one / else_});
    }
    if (!shared || theirs < least_seen) return 0;
    return logOneAgainstTwo(detected_a, detected_b, work.rival_sights);
}

void BernoulliMap::merge(Place older, Place younger) {
    const BernoulliFeature gone = features_.at(younger);  // writing may move what is read
    BernoulliFeature& kept = features_.write(older);
    kept.point = fused(kept.point, gone.point);
    features_.moved(older);
    if (gone.existence.probability() > kept.existence.probability()) kept.existence = gone.existence;
    kept.seen += gone.seen;
    kept.last_seen = std::max(kept.last_seen, gone.last_seen);
}

}  // namespace slamot

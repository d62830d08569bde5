#include "PhdLikelihood.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace slamot {
namespace {

/// The component known best among the landmarks in view; null: there is none.
const PhdMap::Seen* knownBest(const PhdMap::Settings& settings, const PhdMap::Work& work) {
    const PhdMap::Seen* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const PhdMap::Seen& seen : work.seen) {
        const double size = seen.from.point.covariance.determinant();
        if (!seen.surely || seen.from.weight <= settings.parameters.landmark_above || size >= least) continue;
        least = size;
        best = &seen;
    }
    return best;
}

/// Log of (1 - P_D + P_D sum_z N(z; h(m), R) / c) v-(m) / v(m) for a landmark at m, with the density's values
/// before and after.
double logSingle(const PhdMap::Settings& settings, const Vector3& pose, int view, const Vector2& m,
                 const PhdMap::Work& work) {
    double before = 0, after = 0;
    for (const PhdMap::Seen& seen : work.seen) before += seen.from.weight * densityAt(m, seen.from.point);
    for (const PhdTerm& term : work.terms) after += term.weight * densityAt(m, term.point);
    const SensorPlace place = placeOf(pose, work.scan.views[static_cast<std::size_t>(view)].sensor);
    const PointSight exact = sightOf({m, Matrix2::Zero()}, place, GaussianTransform::linear);
    double ratio = 1 - settings.parameters.detection_probability;
    for (const PhdSight& sight : work.scan.sights) {
        if (sight.view != view) continue;
        const PointInnovation innovation(exact, sight.z, sight.R);
        ratio += std::exp(settings.log_detection + innovation.logLikelihood() - sight.log_unexplained);
    }
    return std::log(ratio * before / after);
}

}  // namespace

double logLikelihood(const PhdMap::Settings& settings, const Vector3& pose, int view,
                     const PhdMap::Work& work) {
    const PhdMapParameters& p = settings.parameters;
    double out = 0;
    if (p.likelihood == PhdLikelihood::set) {
        for (std::size_t s = 0; s < work.shares.size(); ++s)
            if (work.scan.sights[s].view == view) out += std::log(work.shares[s].all);
        for (const PhdMap::Seen& seen : work.seen)
            if (seen.surely) out -= p.detection_probability * seen.from.weight;
        return out;
    }
    // Bayes' rule for a map M: p(Z) = p(Z | M) p-(M) / p(M), with p(M) = exp(-sum w) prod_m v(m).
    for (const PhdTerm& term : work.terms) out += term.weight;
    for (const PhdMap::Seen& seen : work.seen) out -= seen.from.weight;
    if (p.likelihood == PhdLikelihood::single_feature)
        if (const PhdMap::Seen* best = knownBest(settings, work))
            out += logSingle(settings, pose, view, best->from.point.mean, work);
    return out;
}

}  // namespace slamot

#include "slamot/core/estimation/OutlierGate.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "slamot/core/models/RangeBearing.h"

namespace slamot {
namespace {

/// nu = sum mu_j nu_j, S = sum mu_j [S_j + (nu_j - nu)(nu_j - nu)^t]; NIS under them.
void combine(const Eigen::VectorXd& mu, const std::vector<Linearisation>& by_mode, Innovation& out) {
    const auto mode = [&](Eigen::Index j) -> const Linearisation& {
        return by_mode[static_cast<std::size_t>(j)];
    };
    Eigen::Index reference = 0;  // bearings differ by less than a turn from the likeliest mode's
    mu.maxCoeff(&reference);
    const Vector2 origin = mode(reference).measurement.residual;
    const auto deviation = [&](Eigen::Index j) {
        return rangeBearingResidual(mode(j).measurement.residual, origin);
    };

    Vector2 shift = Vector2::Zero();
    for (Eigen::Index j = 0; j < mu.size(); ++j) shift += mu(j) * deviation(j);
    out.covariance.setZero();
    for (Eigen::Index j = 0; j < mu.size(); ++j) {
        const Vector2 spread = deviation(j) - shift;
        out.covariance += mu(j) * (mode(j).S + spread * spread.transpose());
    }
    out.residual = rangeBearingResidual(origin, -shift);
    out.nis = out.residual.dot(out.covariance.llt().solve(out.residual));
}

}  // namespace

Matrix2 OutlierGate::judge(const Eigen::VectorXd& mu, const std::vector<Linearisation>& by_mode,
                           const RangeBearingDetection& detection, Innovation& innovation) const {
    combine(mu, by_mode, innovation);
    innovation.outcome = Outcome::updated;
    const double nis = std::min_element(by_mode.begin(), by_mode.end(), [](const auto& a, const auto& b) {
                           return a.nis < b.nis;
                       })->nis;
    // NIS of two rows stays below this with that probability: the chi-square quantile in closed form.
    const double gate = -2.0 * std::log1p(-probability);
    if (nis <= gate || treatment == OutlierTreatment::accept) return Matrix2::Zero();
    innovation.outcome = treatment == OutlierTreatment::reject ? Outcome::rejected : Outcome::inflated;
    return (std::pow(nis / gate, 2) - 1.0) * detection.covariance;
}

}  // namespace slamot

#include "slamot/core/estimation/TargetMixture.h"

namespace slamot {

TargetGaussian mixture(const Eigen::Ref<const Eigen::VectorXd>& w, const std::vector<TargetGaussian>& modes) {
    if (modes.size() == 1) return modes.front();
    TargetGaussian out{Vector6::Zero(), Matrix6::Zero()};
    for (std::size_t i = 0; i < modes.size(); ++i)
        out.mean += w(static_cast<Eigen::Index>(i)) * modes[i].mean;
    for (std::size_t i = 0; i < modes.size(); ++i) {
        const Vector6 spread = modes[i].mean - out.mean;
        out.covariance +=
            w(static_cast<Eigen::Index>(i)) * (modes[i].covariance + spread * spread.transpose());
    }
    return out;
}

MixedModes mixedModes(const Eigen::MatrixXd& p, const Eigen::VectorXd& mu,
                      const std::vector<TargetGaussian>& modes) {
    if (modes.size() == 1) return {mu, modes};
    MixedModes out{p.transpose() * mu, {}};
    out.modes.reserve(modes.size());
    for (Eigen::Index j = 0; j < mu.size(); ++j) {
        const double c = out.probabilities(j);
        out.modes.push_back(mixture(c > 0 ? Eigen::VectorXd(p.col(j).cwiseProduct(mu) / c) : mu, modes));
    }
    return out;
}

}  // namespace slamot

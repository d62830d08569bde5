#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <unsupported/Eigen/MatrixFunctions>

#include "slamot/core/estimation/TargetModes.h"

namespace slamot {
namespace {

/// Row sums typed with a few decimals, and logarithms of matrices, are good to about this.
constexpr double rounding = 1e-9;

void requireProbabilities(const Eigen::VectorXd& p, const std::string& what) {
    if (!(p.minCoeff() >= 0) || !(std::abs(p.sum() - 1.0) <= rounding))
        throw std::invalid_argument(
            fmt::format("{} sums to {:.9g}, expected probabilities that sum to 1", what, p.sum()));
}

/// G with exp(G interval) = p, whose rows sum to 0 and whose entries beside the diagonal are rates >= 0.
Eigen::MatrixXd generatorOf(const Eigen::MatrixXd& p, double interval) {
    const Eigen::MatrixXd log_p = p.log();
    Eigen::MatrixXd G = log_p.cwiseMax(0.0);
    G.diagonal().setZero();
    G.diagonal() = -G.rowwise().sum();
    // The logarithm of a matrix with a negative eigenvalue is not real, and does not lead back.
    if (!log_p.allFinite() || !(log_p - G).isZero(rounding) || !(G.exp() - p).isZero(rounding))
        throw std::invalid_argument(
            "no chain in continuous time has this transition matrix (its logarithm is no matrix of rates), "
            "expected "
            "larger probabilities to stay, or transition_interval = 0");
    return G / interval;
}

}  // namespace

ModeChain::ModeChain(const Eigen::MatrixXd& p, double interval) : p_(p) {
    for (Eigen::Index i = 0; i < p.rows(); ++i)
        requireProbabilities(p.row(i), fmt::format("row {} of the transition matrix", i + 1));
    if (interval > 0) generator_ = generatorOf(p, interval);
}

Eigen::MatrixXd ModeChain::over(double dt) const {
    if (generator_.size() == 0) return p_;
    return (generator_ * dt).exp();
}

ModeChain chainOf(const ImmParameters& parameters) {
    const auto n = static_cast<Eigen::Index>(parameters.modes.size());
    if (n <= 1) return {};
    Eigen::MatrixXd p =
        Eigen::MatrixXd::Constant(n, n, (1.0 - parameters.stay_probability) / static_cast<double>(n - 1));
    p.diagonal().setConstant(parameters.stay_probability);
    if (parameters.transition) {
        const auto& given = *parameters.transition;
        if (given.size() != static_cast<std::size_t>(n * n))
            throw std::invalid_argument(
                fmt::format("transition has {} numbers, expected {} rows of {}", given.size(), n, n));
        p = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            given.data(), n, n);
    }
    return {p, parameters.transition_interval};
}

Eigen::VectorXd initialProbabilities(const ImmParameters& parameters) {
    const auto n = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(parameters.modes.size()));
    if (!parameters.initial) return Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n));
    const auto& given = *parameters.initial;
    if (given.size() != static_cast<std::size_t>(n))
        throw std::invalid_argument(
            fmt::format("initial has {} numbers, expected {}, one for each mode", given.size(), n));
    const Eigen::VectorXd mu = Eigen::Map<const Eigen::VectorXd>(given.data(), n);
    requireProbabilities(mu, "initial");
    return mu;
}

std::vector<TargetModel> modelsOf(const ImmParameters& parameters) {
    std::vector<TargetModel> models;
    for (const TargetMode& mode : parameters.modes) {
        models.push_back(mode.model);
        models.back().noise_interval = parameters.noise_interval;
    }
    return models;
}

const TargetModel& simplestOf(const std::vector<TargetModel>& models) {
    return *std::min_element(models.begin(), models.end(), [](const TargetModel& a, const TargetModel& b) {
        return std::make_tuple(a.kind, -a.noise_std, a.turn_rate) <
               std::make_tuple(b.kind, -b.noise_std, b.turn_rate);
    });
}

}  // namespace slamot

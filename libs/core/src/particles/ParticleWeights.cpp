#include "slamot/core/particles/ParticleWeights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slamot {
namespace {

/// exp(-this) is the smallest number there is: weights stay finite and nothing is divided by 0.
constexpr double log_of_nothing = 745;

/// Weights below count for nothing: moments of so little lose their digits, and with them what makes them
/// definite.
constexpr double least_weight = 1e-100;

/// Children of weights that sum to `total`: child k goes to the weight that contains (k + offset) / count of
/// it.
void appendSystematic(const std::vector<double>& weights, double total, int count, double offset,
                      std::vector<int>& parents) {
    const double step = total / count;
    double reached = weights.front();
    std::size_t i = 0;
    for (int k = 0; k < count; ++k) {
        const double at = (k + offset) * step;
        while (reached < at && i + 1 < weights.size()) reached += weights[++i];
        parents.push_back(static_cast<int>(i));
    }
}

}  // namespace

ParticleWeights::ParticleWeights(int count)
    : log_weights_(static_cast<std::size_t>(count)), weights_(static_cast<std::size_t>(count)) {
    setEqual();
}

void ParticleWeights::setEqual(int best) {
    best_ = best;
    std::fill(log_weights_.begin(), log_weights_.end(), -std::log(static_cast<double>(count())));
    std::fill(weights_.begin(), weights_.end(), 1.0 / count());
}

bool ParticleWeights::multiply(const std::vector<double>& log_factors) {
    double least = std::numeric_limits<double>::infinity();
    for (const double f : log_factors)
        if (std::isfinite(f)) least = std::min(least, f);
    if (!std::isfinite(least)) return false;
    for (std::size_t i = 0; i < log_weights_.size(); ++i)
        log_weights_[i] += std::isfinite(log_factors[i]) ? log_factors[i] : least - log_of_nothing;
    normalise();
    return true;
}

void ParticleWeights::normalise() {
    const double largest = *std::max_element(log_weights_.begin(), log_weights_.end());
    double sum = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i)
        sum += weights_[i] = std::exp(log_weights_[i] -= largest);
    const double log_sum = std::log(sum);
    for (double& w : weights_) w = w / sum < least_weight ? 0 : w / sum;
    for (double& w : log_weights_) w -= log_sum;
    best_ = static_cast<int>(std::max_element(weights_.begin(), weights_.end()) - weights_.begin());
}

double ParticleWeights::effectiveCount() const {
    double squares = 0;
    for (const double w : weights_) squares += w * w;
    return 1 / squares;
}

std::vector<int> ParticleWeights::resampled(Resampling method, RandomStream& random) const {
    const int n = count();
    std::vector<int> parents;
    parents.reserve(weights_.size());
    if (method == Resampling::systematic) {
        appendSystematic(weights_, 1.0, n, random.uniform(), parents);
        return parents;
    }
    std::vector<double> rest = weights_;
    double left = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
        const double copies = std::floor(n * weights_[i]);
        parents.insert(parents.end(), static_cast<std::size_t>(copies), static_cast<int>(i));
        rest[i] = n * weights_[i] - copies;
        left += rest[i];
    }
    const int missing = n - static_cast<int>(parents.size());
    if (missing > 0) appendSystematic(rest, left, missing, random.uniform(), parents);
    std::sort(parents.begin(), parents.end());
    return parents;
}

std::vector<KeptParticle> thinned(const std::vector<double>& weights, int most) {
    std::vector<KeptParticle> kept;
    if (weights.size() <= static_cast<std::size_t>(most)) {
        for (std::size_t i = 0; i < weights.size(); ++i) kept.push_back({i, weights[i]});
        return kept;
    }
    std::vector<int> picked;
    appendSystematic(weights, 1.0, most, 0.5, picked);
    for (const int i : picked) {
        const auto index = static_cast<std::size_t>(i);
        if (kept.empty() || kept.back().index != index) kept.push_back({index, 0});
        kept.back().weight += 1.0 / most;
    }
    return kept;
}

}  // namespace slamot

#pragma once
// Weights of particles, in logarithms, and who survives.
#include <cstddef>
#include <vector>

#include "slamot/core/random/RandomStream.h"

namespace slamot {

enum class Resampling {
    systematic,  ///< one draw for all: number of children within 1 of N w
    residual     ///< floor(N w) children each, the rest drawn by systematic resampling of what is left
};

class ParticleWeights {
  public:
    explicit ParticleWeights(int count = 1);

    int count() const { return static_cast<int>(log_weights_.size()); }
    /// Normalised since the last `normalise`.
    double operator[](int i) const { return weights_[static_cast<std::size_t>(i)]; }
    /// `best`: the one that goes on as the heaviest, since equal weights do not tell.
    void setEqual(int best = 0);

    /// w_i <- w_i exp(log_factor_i), normalised. Factors that are not finite count as 0; if none is finite the
    /// weights stay as they were, which is said by false.
    bool multiply(const std::vector<double>& log_factors);

    /// 1 / sum w^2: between 1 and count().
    double effectiveCount() const;
    /// The lowest number among the heaviest; after setEqual the one named there.
    int best() const { return best_; }
    /// The parent of each child, ascending.
    std::vector<int> resampled(Resampling method, RandomStream& random) const;

  private:
    void normalise();

    std::vector<double> log_weights_, weights_;
    int best_ = 0;
};

/// One of those that stand for all, in files and pictures.
struct KeptParticle {
    std::size_t index;
    double weight;
};

/// Of particles whose weights sum to 1 at most `most` (1 or more), ascending: systematic resampling without chance, the
/// same ones joined. Where there are no more than that, all of them with the weights they have.
std::vector<KeptParticle> thinned(const std::vector<double>& weights, int most);

}  // namespace slamot

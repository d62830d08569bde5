#pragma once
// Gates are given as probabilities; filters compare squared distances. This is the way from one to the other.
#include <vector>

namespace slamot {

/// The value that a chi-square variable of that many degrees of freedom stays below with `probability`, which
/// lies in (0, 1).
double chiSquareQuantile(double probability, double degrees);

/// Gates of one probability for sets of pairs of two rows each. A quantile takes microseconds, so each is
/// computed once: keep this for a run.
class PairGates {
  public:
    explicit PairGates(double probability) : probability_(probability) {}
    double probability() const { return probability_; }
    double operator()(int pairs);

  private:
    double probability_;
    std::vector<double> gates_{0};  ///< [pairs]
};

}  // namespace slamot

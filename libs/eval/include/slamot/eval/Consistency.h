#pragma once
// Do the covariances tell the truth? NEES, its chi-square bands, coverage.
#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "slamot/core/data/Stamp.h"
#include "slamot/eval/Measured.h"

namespace slamot::eval {

/// Up to six dimensions, without allocation.
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// A squared error weighted by its inverse covariance, and the number of dimensions it was taken on: those
/// with variance. A value of chi-square law of that many degrees of freedom if the covariance is right.
struct SquaredError {
    double value = 0;
    int dimension = 0;
};

/// e' P^+ e, never divided by the dimension. A coordinate of zero variance is known exactly and left out, and
/// so is a direction whose variance is below 1e-9 of the largest (the definiteness tolerance) once P is scaled to a correlation matrix.
SquaredError nees(const SmallVector& error, const SmallMatrix& covariance);

struct NeesStep {
    Stamp stamp;
    SquaredError squared;
};
using NeesSeries = std::vector<NeesStep>;

struct Band {
    double low = 0, high = 0;
    bool contains(double v) const { return low <= v && v <= high; }
};

/// Two-sided: `probability` inside, equal parts below and above, for the mean of `count` values whose degrees
/// of freedom add up to `total_degrees`.
Band chiSquareBand(double probability, double total_degrees, double count = 1);

/// Bands and quantiles of one probability, each computed once.
class ChiSquareTable {
  public:
    explicit ChiSquareTable(double probability) : probability_(probability) {}
    const Band& band(int dimension);
    double quantile(int dimension);

  private:
    double probability_;
    std::map<int, Band> bands_;
    std::map<int, double> quantiles_;
};

struct NeesSummary {
    /// Steps used; steps left out since nothing had variance; steps used on fewer dimensions than the most.
    std::int64_t steps = 0, without_variance = 0, reduced = 0;
    /// What the average is when covariances are right.
    double mean_dimension = 0;
    /// Average over steps (ANEES), and the median.
    double average = 0, median = 0;
    /// Of a single step, on the most dimensions that occur.
    Band band;
    /// Part of the steps inside their two-sided band, and part below the one-sided quantile (coverage).
    double inside = 0, coverage = 0;
};
/// Absent when no step has variance: a covariance of zero throughout means 'unknown'.
Measured<NeesSummary> summariseNees(const NeesSeries& series, double probability);

/// One stamp over several runs.
struct ConsistencyStep {
    Stamp stamp;
    int runs = 0;
    double mean = 0;
    Band band;
};

struct ConsistencyOverRuns {
    int runs = 0;
    std::vector<ConsistencyStep> steps;
    /// Part of the steps whose mean lies inside the band, above it (over-confident) and below it.
    double inside = 0, above = 0, below = 0;
    /// Average over runs and steps, and what it should be.
    double average = 0, mean_dimension = 0;
};
/// Per stamp, the mean over the runs that have it. Absent when no run has a step with variance.
Measured<ConsistencyOverRuns> consistencyOverRuns(const std::vector<NeesSeries>& runs, double probability);

}  // namespace slamot::eval

#pragma once
// Innovations: the one test of consistency that needs no truth.
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "slamot/eval/Measured.h"
#include "slamot/eval/RunRecord.h"

namespace slamot::eval {

/// Innovations of one sensor and kind.
struct NisGroup {
    std::string sensor;
    ObjectKind kind = ObjectKind::unknown;
    /// Rows by outcome.
    std::map<Outcome, std::int64_t> outcomes;
    /// Rows with a prediction of the estimate: the ones the numbers below are made from, rejected ones
    /// included (leaving them out would make any filter look consistent), tentative ones not.
    std::int64_t count = 0;
    /// Sum of NIS over sum of degrees of freedom: 1 when noises are right. Misreads raise it without bound.
    /// NaN, like the following, when `count` is 0.
    double mean_per_degree = none;
    /// Median of NIS per degree: 0.693 for two degrees of freedom; hardly moved by misreads.
    double median_per_degree = none;
    /// Part inside the two-sided band, and below the one-sided quantile.
    double inside = none, coverage = none;

    static constexpr double none = std::numeric_limits<double>::quiet_NaN();
};

/// Whether an innovation is of a prediction of the estimate; tentative ones are measured against what is no
/// part of it.
bool countsForNis(const Innovation& innovation);

Measured<std::vector<NisGroup>> nisBySensor(const std::vector<InnovationRow>& innovations,
                                            double probability);

}  // namespace slamot::eval

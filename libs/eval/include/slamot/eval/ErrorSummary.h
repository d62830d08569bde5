#pragma once
#include <cstdint>
#include <limits>
#include <vector>

namespace slamot::eval {

/// What is told of a list of errors, in their unit. Signs are dropped. NaN when the list is empty.
struct ErrorSummary {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();

    std::int64_t count = 0;
    double rmse = none, mean = none, median = none, maximum = none;
    /// Of the last one.
    double final = none;
};

/// NaNs (unknown) are left out.
ErrorSummary summariseErrors(const std::vector<double>& errors);

}  // namespace slamot::eval

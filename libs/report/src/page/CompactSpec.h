#pragma once
#include <nlohmann/json.hpp>

namespace slamot::report {

/// A specification of figureSpec for a page: the rows of its data sets by columns, and numbers with as many
/// digits as a hundredth of a pixel needs, which is what makes long runs small. assets/plot.js makes rows
/// again.
nlohmann::json compactSpec(nlohmann::json spec);

/// `value` to `digits` digits after the decimal point (before it, when negative).
double rounded(double value, int digits);

}  // namespace slamot::report

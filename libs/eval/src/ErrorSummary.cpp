#include "slamot/eval/ErrorSummary.h"

#include <cmath>

#include "Median.h"

namespace slamot::eval {

ErrorSummary summariseErrors(const std::vector<double>& errors) {
    std::vector<double> magnitudes;
    magnitudes.reserve(errors.size());
    for (const double e : errors)
        if (!std::isnan(e)) magnitudes.push_back(std::abs(e));

    ErrorSummary summary;
    if (magnitudes.empty()) return summary;
    summary.count = static_cast<std::int64_t>(magnitudes.size());
    double sum = 0, squares = 0, maximum = 0;
    for (const double m : magnitudes) {
        sum += m;
        squares += m * m;
        maximum = std::max(maximum, m);
    }
    const auto n = static_cast<double>(magnitudes.size());
    summary.rmse = std::sqrt(squares / n);
    summary.mean = sum / n;
    summary.maximum = maximum;
    summary.final = magnitudes.back();
    summary.median = median(std::move(magnitudes));
    return summary;
}

}  // namespace slamot::eval

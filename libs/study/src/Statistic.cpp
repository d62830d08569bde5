#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>

#include "StatisticFields.h"

namespace slamot::study {
namespace {

constexpr double tail = 0.025;  // of a two-sided interval of 95 %

/// How many order statistics from each end the interval of a median of `n` values begins: the most, r, for
/// which P(X < r) <= tail with X binomial (n, 1/2). 0 where even the extremes hold the median with less than
/// 95 %.
int medianRank(int n) {
    const boost::math::binomial below(n, 0.5);
    if (n == 0 || cdf(below, 0) > tail) return 0;
    // Boost rounds a lower quantile down by default: the largest k with P(X <= k) <= tail.
    return static_cast<int>(quantile(below, tail)) + 1;
}

}  // namespace

Statistic statisticOf(const std::vector<double>& values) {
    std::vector<double> sorted;
    std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
                 [](double v) { return std::isfinite(v); });
    std::sort(sorted.begin(), sorted.end());

    Statistic s;
    s.count = static_cast<int>(sorted.size());
    if (sorted.empty()) return s;
    const std::size_t n = sorted.size();
    s.minimum = sorted.front();
    s.maximum = sorted.back();
    s.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(n);
    s.median = n % 2 == 1 ? sorted[n / 2] : (sorted[n / 2 - 1] + sorted[n / 2]) / 2;
    if (n > 1) {
        double squares = 0;
        for (const double v : sorted) squares += (v - s.mean) * (v - s.mean);
        s.deviation = std::sqrt(squares / static_cast<double>(n - 1));
        const double t = quantile(boost::math::students_t(static_cast<double>(n - 1)), 1 - tail);
        s.half_width = t * s.deviation / std::sqrt(static_cast<double>(n));
    }
    if (const int rank = medianRank(s.count); rank > 0) {
        s.median_low = sorted[static_cast<std::size_t>(rank - 1)];
        s.median_high = sorted[n - static_cast<std::size_t>(rank)];
    }
    return s;
}

Statistic scaled(Statistic s, double factor) {
    for (const StatisticField& number : statistic_fields) s.*number.field *= factor;
    return s;
}

Rate rateOf(int count, int of) {
    Rate r;
    r.count = count;
    r.of = of;
    if (of == 0) return r;
    // E. B. Wilson, J. Am. Stat. Assoc. 22, 1927.
    const double n = of, z = quantile(boost::math::normal(), 1 - tail);
    r.rate = count / n;
    const double middle = (r.rate + z * z / (2 * n)) / (1 + z * z / n);
    const double half = z / (1 + z * z / n) * std::sqrt(r.rate * (1 - r.rate) / n + z * z / (4 * n * n));
    // At the ends the formula is exact, rounding is not.
    r.low = count == 0 ? 0 : middle - half;
    r.high = count == of ? 1 : middle + half;
    return r;
}

}  // namespace slamot::study

#include "slamot/eval/Consistency.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "Median.h"
#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/plugin/Estimator.h"

namespace slamot::eval {

SquaredError nees(const SmallVector& error, const SmallMatrix& covariance) {
    // Coordinates with variance, scaled by their standard deviations so that units do not weigh.
    SmallVector scaled(error.size());
    Eigen::Array<int, Eigen::Dynamic, 1, 0, 6, 1> kept(error.size());
    Eigen::Index n = 0;
    for (Eigen::Index i = 0; i < error.size(); ++i) {
        if (!(covariance(i, i) > 0)) continue;
        scaled(n) = error(i) / std::sqrt(covariance(i, i));
        kept(n++) = static_cast<int>(i);
    }
    if (n == 0) return {};
    scaled.conservativeResize(n);
    SmallMatrix correlation(n, n);
    for (Eigen::Index r = 0; r < n; ++r)
        for (Eigen::Index c = 0; c < n; ++c)
            correlation(r, c) = covariance(kept(r), kept(c)) /
                                std::sqrt(covariance(kept(r), kept(r)) * covariance(kept(c), kept(c)));

    const Eigen::SelfAdjointEigenSolver<SmallMatrix> eigen(correlation);
    const SmallVector variances = eigen.eigenvalues();
    const SmallVector along = eigen.eigenvectors().transpose() * scaled;
    SquaredError squared;
    for (Eigen::Index i = 0; i < n; ++i) {
        // Below what estimators are held to there is round-off only: the error along it would be weighed by noise.
        if (variances(i) <= Estimator::definiteness_tolerance * variances.maxCoeff()) continue;
        squared.value += along(i) * along(i) / variances(i);
        ++squared.dimension;
    }
    return squared;
}

Band chiSquareBand(double probability, double total_degrees, double count) {
    const double tail = (1 - probability) / 2;
    return {chiSquareQuantile(tail, total_degrees) / count,
            chiSquareQuantile(1 - tail, total_degrees) / count};
}

const Band& ChiSquareTable::band(int dimension) {
    const auto [place, is_new] = bands_.try_emplace(dimension);
    if (is_new) place->second = chiSquareBand(probability_, dimension);
    return place->second;
}

double ChiSquareTable::quantile(int dimension) {
    const auto [place, is_new] = quantiles_.try_emplace(dimension);
    if (is_new) place->second = chiSquareQuantile(probability_, dimension);
    return place->second;
}

Measured<NeesSummary> summariseNees(const NeesSeries& series, double probability) {
    ChiSquareTable table(probability);
    NeesSummary summary;
    std::vector<double> values;
    int most_dimensions = 0;
    double sum = 0;
    std::int64_t dimensions = 0, inside = 0, covered = 0;
    std::map<int, std::int64_t> steps_by_dimension;
    for (const NeesStep& step : series) {
        const auto [value, dimension] = step.squared;
        if (dimension == 0) {
            ++summary.without_variance;
            continue;
        }
        values.push_back(value);
        sum += value;
        dimensions += dimension;
        ++steps_by_dimension[dimension];
        most_dimensions = std::max(most_dimensions, dimension);
        inside += table.band(dimension).contains(value);
        covered += value <= table.quantile(dimension);
    }
    if (values.empty())
        return Measured<NeesSummary>::absent(series.empty()
                                                 ? "nothing was matched with truth"
                                                 : "every covariance is zero, which means it is not known");
    const auto n = static_cast<double>(values.size());
    summary.steps = static_cast<std::int64_t>(values.size());
    summary.reduced = summary.steps - steps_by_dimension[most_dimensions];
    summary.mean_dimension = static_cast<double>(dimensions) / n;
    summary.average = sum / n;
    summary.band = table.band(most_dimensions);
    summary.inside = static_cast<double>(inside) / n;
    summary.coverage = static_cast<double>(covered) / n;
    summary.median = median(std::move(values));
    return summary;
}

Measured<ConsistencyOverRuns> consistencyOverRuns(const std::vector<NeesSeries>& runs, double probability) {
    struct Sum {
        int runs = 0, dimension = 0;
        double value = 0;
    };
    std::map<Stamp, Sum> by_stamp;
    for (const NeesSeries& run : runs)
        for (const NeesStep& step : run) {
            if (step.squared.dimension == 0) continue;
            Sum& sum = by_stamp[step.stamp];
            ++sum.runs;
            sum.dimension += step.squared.dimension;
            sum.value += step.squared.value;
        }
    if (by_stamp.empty())
        return Measured<ConsistencyOverRuns>::absent(
            "no run has a step whose covariance is known and not zero");

    ConsistencyOverRuns result;
    result.runs = static_cast<int>(runs.size());
    std::map<std::pair<int, int>, Band> bands;
    double value = 0, dimension = 0, samples = 0;
    for (const auto& [stamp, sum] : by_stamp) {
        const auto [place, is_new] = bands.try_emplace({sum.runs, sum.dimension});
        if (is_new) place->second = chiSquareBand(probability, sum.dimension, sum.runs);
        const ConsistencyStep step{stamp, sum.runs, sum.value / sum.runs, place->second};
        result.steps.push_back(step);
        result.inside += step.band.contains(step.mean);
        result.above += step.mean > step.band.high;
        result.below += step.mean < step.band.low;
        value += sum.value;
        dimension += sum.dimension;
        samples += sum.runs;
    }
    const auto n = static_cast<double>(result.steps.size());
    result.inside /= n;
    result.above /= n;
    result.below /= n;
    result.average = value / samples;
    result.mean_dimension = dimension / samples;
    return result;
}

}  // namespace slamot::eval

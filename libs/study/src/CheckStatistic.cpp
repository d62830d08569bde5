#include "CheckStatistic.h"

#include <cmath>

namespace slamot::study {

const std::vector<CheckStatistic>& checkStatistics() {
    using S = const Statistic&;
    using P = const Paired&;
    using C = const eval::ConsistencyOverRuns&;
    static const std::vector<CheckStatistic> all = {
        {"mean", "mean of {}", true, OfFigure([](S s) { return s.mean; })},
        {"median", "median of {}", true, OfFigure([](S s) { return s.median; })},
        {"minimum", "least {}", true, OfFigure([](S s) { return s.minimum; })},
        {"maximum", "largest {}", true, OfFigure([](S s) { return s.maximum; })},
        {"ratio", "mean ratio of {}", false, OfPairs([](P p) { return p.ratio.mean; })},
        {"median_ratio", "median ratio of {}", false, OfPairs([](P p) { return p.ratio.median; })},
        {"ratio_of_means", "ratio of mean {}", false, OfPairs([](P p) { return p.mean_a / p.mean_b; })},
        {"mean_difference", "mean difference of {}", true, OfPairs([](P p) { return p.difference.mean; })},
        {"median_difference", "median difference of {}", true,
         OfPairs([](P p) { return p.difference.median; })},
        {"smaller", "part of worlds with the smaller {}", false,
         OfPairs([](P p) { return static_cast<double>(p.smaller) / p.difference.count; })},
        {"anees", "average of {}", false, OfSeries([](C c) { return c.average; })},
        {"inside", "steps in the band of {}", false, OfSeries([](C c) { return c.inside; })},
        {"above", "steps above the band of {}", false, OfSeries([](C c) { return c.above; })},
        {"below", "steps below the band of {}", false, OfSeries([](C c) { return c.below; })},
        {"window_mean", "mean over time of {}", true, OfWindow{[](S s) { return s.mean; }}},
        {"window_median", "median over runs of the mean over time of {}", true,
         OfWindow{[](S s) { return s.median; }}},
        {"rate", "part that failed or diverged", false,
         OfDivergence([](const Divergence& d) { return d.lost.rate; })}};
    return all;
}

std::vector<double> windowMeans(const Cell& cell, const std::string& series, const eval::Band& window) {
    std::vector<double> means;
    for (const Row* row : cell.rows) {
        const auto found = row->series.find(series);
        if (hasFailed(*row) || found == row->series.end()) continue;
        double sum = 0;
        int count = 0;
        for (std::size_t i = 0; i < found->second.value.size(); ++i) {
            const double value = found->second.value[i];
            if (!window.contains(found->second.seconds[i]) || !std::isfinite(value)) continue;
            sum += value;
            ++count;
        }
        if (count > 0) means.push_back(sum / count);
    }
    return means;
}

}  // namespace slamot::study

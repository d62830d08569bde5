#include "slamot/eval/Nis.h"

#include <cmath>
#include <tuple>
#include <utility>

#include "Median.h"
#include "slamot/eval/Consistency.h"

namespace slamot::eval {

bool countsForNis(const Innovation& innovation) {
    return std::isfinite(innovation.nis) && innovation.outcome != Outcome::tentative;
}

Measured<std::vector<NisGroup>> nisBySensor(const std::vector<InnovationRow>& innovations,
                                            double probability) {
    if (innovations.empty()) return Measured<std::vector<NisGroup>>::absent("the run has no innovations");

    // Range and bearing: an innovation's S is positive definite, so both always count.
    constexpr int degrees = 2;
    struct Collected {
        std::map<Outcome, std::int64_t> outcomes;
        std::vector<double> values;
    };
    std::map<std::pair<std::string, ObjectKind>, Collected> groups;
    for (const InnovationRow& row : innovations) {
        Collected& group = groups[{row.sensor, row.innovation.kind}];
        ++group.outcomes[row.innovation.outcome];
        if (countsForNis(row.innovation)) group.values.push_back(row.innovation.nis);
    }

    ChiSquareTable table(probability);
    std::vector<NisGroup> result;
    for (auto& [key, collected] : groups) {
        NisGroup group;
        std::tie(group.sensor, group.kind) = key;
        group.outcomes = collected.outcomes;
        group.count = static_cast<std::int64_t>(collected.values.size());
        double sum = 0;
        std::int64_t inside = 0, covered = 0;
        for (const double nis : collected.values) {
            sum += nis;
            inside += table.band(degrees).contains(nis);
            covered += nis <= table.quantile(degrees);
        }
        if (group.count > 0) {
            const auto n = static_cast<double>(group.count);
            group.mean_per_degree = sum / (degrees * n);
            group.median_per_degree = median(std::move(collected.values)) / degrees;
            group.inside = static_cast<double>(inside) / n;
            group.coverage = static_cast<double>(covered) / n;
        }
        result.push_back(std::move(group));
    }
    return result;
}

}  // namespace slamot::eval

#include "OverTime.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace slamot::study {
namespace {

constexpr int interval_count = 300;  // about as many as a figure can show

/// One value of each run that has one, by time.
using Values = std::map<Stamp, std::vector<double>>;

std::vector<const Series*> seriesOf(const Cell& cell, const std::string& name) {
    std::vector<const Series*> runs;
    for (const Row* row : cell.rows)
        if (const auto found = row->series.find(name);
            !hasFailed(*row) && found != row->series.end() && !found->second.value.empty())
            runs.push_back(&found->second);
    return runs;
}

Values byTime(const std::vector<const Series*>& runs) {
    Values values;
    for (const Series* run : runs)
        for (std::size_t i = 0; i < run->value.size(); ++i)
            if (std::isfinite(run->value[i]))
                values[Stamp::fromSeconds(run->seconds[i])].push_back(run->value[i]);
    return values;
}

/// At most times half of the runs or more have a value.
bool timesAreShared(const Values& values, std::size_t runs) {
    std::size_t samples = 0;
    for (const auto& [time, list] : values) samples += list.size();
    return 2 * samples >= runs * values.size();
}

Values byInterval(const std::vector<const Series*>& runs, double begin, double length) {
    Values values;
    for (const Series* run : runs) {
        std::map<int, std::pair<double, int>> sums;
        for (std::size_t i = 0; i < run->value.size(); ++i) {
            if (!std::isfinite(run->value[i])) continue;
            const int interval = static_cast<int>((run->seconds[i] - begin) / length);
            auto& [sum, count] = sums[std::min(interval, interval_count - 1)];
            sum += run->value[i];
            ++count;
        }
        for (const auto& [interval, sum] : sums)
            values[Stamp::fromSeconds(begin + (interval + 0.5) * length)].push_back(sum.first / sum.second);
    }
    return values;
}

}  // namespace

double quantileOf(const std::vector<double>& sorted, double part) {
    const double place = part * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Course courseOf(const Cell& cell, const std::string& name) {
    const std::vector<const Series*> runs = seriesOf(cell, name);
    Course course;
    course.runs = static_cast<int>(runs.size());
    Values values = byTime(runs);
    if (values.empty()) return course;
    if (!timesAreShared(values, runs.size())) {
        const double begin = values.begin()->first.seconds();
        course.interval = (values.rbegin()->first.seconds() - begin) / interval_count;
        values = byInterval(runs, begin, course.interval);
    }
    for (auto& [time, list] : values) {
        std::sort(list.begin(), list.end());
        const double sum = std::accumulate(list.begin(), list.end(), 0.0);
        course.steps.push_back({time.seconds(), static_cast<int>(list.size()),
                                sum / static_cast<double>(list.size()), quantileOf(list, 0.5),
                                quantileOf(list, 0.1), quantileOf(list, 0.9)});
    }
    return course;
}

}  // namespace slamot::study

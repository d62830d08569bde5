#include "sections/Courses.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slamot::report {

void ErrorCourse::add(double t, double e, double s) {
    seconds.push_back(t);
    error.push_back(e);
    sigma.push_back(s);
}

double longestInterval(const std::vector<double>& intervals) {
    return 5 * quantile(intervals, 0.5);
}

void breakAtGaps(ErrorCourse& course) {
    const std::vector<double>& t = course.seconds;
    std::vector<double> intervals;
    for (std::size_t i = 1; i < t.size(); ++i) {
        intervals.push_back(t[i] - t[i - 1]);
    }
    const double longest = longestInterval(intervals);
    ErrorCourse broken;
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (i > 0 && t[i] - t[i - 1] > longest) {
            broken.add(0.5 * (t[i] + t[i - 1]), std::nan(""), std::nan(""));
        }
        broken.add(t[i], course.error[i], course.sigma[i]);
    }
    course = std::move(broken);
}

Axis runTimeAxis(const RunFolder& run) {
    Axis axis = timeAxis("Time since the start");
    if (run.duration() > 0) {
        axis.min = 0;
        axis.max = run.duration();
    }
    return axis;
}

Panel errorPanel(const RunFolder& run, const std::string& label, const std::string& unit,
                 const ErrorCourse& course, const std::string& colour) {
    Panel panel;
    panel.x = runTimeAxis(run);
    panel.y.label = label;
    panel.y.unit = unit;
    panel.height = 150;
    if (std::any_of(course.sigma.begin(), course.sigma.end(), [](double s) { return s > 0; })) {
        Band band{"±3σ", sigmaBand(course.seconds, course.sigma), colour::grey, 0.22};
        panel.layers.push_back(std::move(band));
    }
    panel.layers.push_back(Line{"Error", series(course.seconds, course.error), colour, 1.3});
    return panel;
}

double partWithinThreeSigma(const ErrorCourse& course) {
    std::size_t known = 0, within = 0;
    for (std::size_t i = 0; i < course.error.size(); ++i) {
        if (std::isfinite(course.error[i]) && course.sigma[i] > 0) {
            ++known;
            within += std::abs(course.error[i]) <= 3 * course.sigma[i];
        }
    }
    return known > 0 ? 100.0 * static_cast<double>(within) / static_cast<double>(known)
                     : std::numeric_limits<double>::quiet_NaN();
}

Windows::Windows(const RunFolder& run, std::size_t count)
    : run_(run), count_(count), length_(std::max(run.duration(), 1e-9) / static_cast<double>(count)) {}

std::size_t Windows::of(Stamp stamp) const {
    return at(run_.seconds(stamp));
}

std::size_t Windows::at(double seconds) const {
    const double place = seconds / length_;
    return place <= 0 ? 0 : std::min(static_cast<std::size_t>(place), count_ - 1);
}

Windows windowsFor(const RunFolder& run, std::size_t count, std::size_t most, std::size_t each) {
    return Windows(run, std::clamp<std::size_t>(count / each, 1, most));
}

double quantile(std::vector<double> values, double part) {
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    std::sort(values.begin(), values.end());
    const double place = part * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

std::vector<Band> stackedSteps(const Windows& windows, const std::vector<std::vector<double>>& rows,
                               const std::vector<std::string>& labels,
                               const std::vector<std::string>& colours) {
    std::vector<double> sum(windows.count(), 0);
    std::vector<Band> bands;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        Band band{labels[k], {}, colours[k], 0.85};
        bool any = false;
        for (std::size_t w = 0; w < windows.count(); ++w) {
            const double low = sum[w], high = low + rows[k][w];
            any = any || high > low;
            band.rows.push_back({windows.begin(w), low, high});
            band.rows.push_back({windows.begin(w + 1), low, high});
            sum[w] = high;
        }
        if (any) {
            bands.push_back(std::move(band));
        }
    }
    return bands;
}

std::optional<TrueTarget> truthOf(const RunFolder& run, SourceId source, Stamp stamp) {
    return run.truth && source.valid() ? run.truth->targetAt(source, stamp) : std::nullopt;
}

}  // namespace slamot::report

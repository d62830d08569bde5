#include "slamot/study/Figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "OneRunFigure.h"
#include "OverTime.h"
#include "Selected.h"
#include "slamot/report/Figure.h"
#include "slamot/study/OneRun.h"

namespace slamot::study {
namespace {

namespace colour = report::colour;

/// "50 runs" or "48 to 50 runs".
class RunCount {
  public:
    void add(int runs) {
        least_ = most_ == 0 ? runs : std::min(least_, runs);
        most_ = std::max(most_, runs);
    }
    std::string text() const {
        const std::string range =
            least_ == most_ ? std::to_string(most_) : fmt::format("{} to {}", least_, most_);
        return range + (most_ == 1 ? " run" : " runs");
    }

  private:
    int least_ = 0, most_ = 0;
};

/// What a panel is about: a figure or series in one source, at one point of the scenario's grid but for the
/// parameter along the axis.
struct Subject {
    std::string name, title;
    std::vector<Cell> cells;
};

/// "bearing noise = 0.05 rad" from the label "bearing noise [rad]".
std::string assignmentText(const std::string& label, const std::string& value) {
    const auto bracket = label.rfind(" [");
    if (bracket == std::string::npos || label.back() != ']') return fmt::format("{} = {}", label, value);
    const std::string unit = label.substr(bracket + 2, label.size() - bracket - 3);
    return fmt::format("{} = {} {}", label.substr(0, bracket), value, unit);
}

/// An interval that a logarithmic axis can show: what reaches below zero begins at the value itself.
double shownLow(double low, double value, bool logarithmic) {
    return logarithmic && low <= 0 ? value : low;
}

/// Lines in the order of their first point, each by rising x.
struct Curves {
    std::vector<std::string> labels;
    std::map<std::string, std::multimap<double, Statistic>> points;  // cells may share a measured x
    RunCount runs;

    void add(const std::string& label, double x, const Statistic& y) {
        if (y.count == 0 || !std::isfinite(x)) return;
        if (points.count(label) == 0) labels.push_back(label);
        points[label].emplace(x, y);
        runs.add(y.count);
    }
};

class Drawing {
  public:
    Drawing(const PlotSpec& spec, const Findings& findings) : spec_(spec), findings_(findings) {
        for (const Cell& cell : selectedCells(findings, spec.selection))
            if (const std::string label = labelOf(cell);
                std::find(labels_.begin(), labels_.end(), label) == labels_.end())
                labels_.push_back(label);
    }

    report::Figure figure() const {
        const std::vector<Subject> subjects = subjectsOf();
        report::Figure figure;
        figure.title = spec_.title;
        figure.columns = subjects.size() > 1 ? 2 : 1;
        figure.shared_legend = subjects.size() > 1;
        for (const Subject& subject : subjects) {
            report::Panel panel = panelOf(subject);
            panel.height = subjects.size() > 1 ? 210 : 300;
            panel.title = subject.title;
            if (figure.shared_legend) panel.legend = report::LegendPlace::none;
            panel.y.label =
                analysis().label(spec_.kind == PlotKind::against ? spec_.figures[1] : subject.name);
            panel.y.logarithmic = spec_.logarithmic_y;
            panel.x.logarithmic = spec_.logarithmic_x;
            if (panel.layers.empty()) panel.note = "no run has this";
            figure.panels.push_back(std::move(panel));
        }
        return figure;
    }

  private:
    const Analysis& analysis() const { return findings_.analysis; }
    bool ofMedians() const { return spec_.shown == Shown::median; }

    std::vector<Subject> subjectsOf() const {
        if (spec_.kind == PlotKind::against)  // all in one, whatever the source
            return {{spec_.figures[0], "", selectedCells(findings_, spec_.selection)}};
        std::vector<std::pair<std::string, std::vector<Cell>>> panels;  // by title
        for (const Cell& cell : selectedCells(findings_, spec_.selection)) {
            const std::string title = titleOf(cell);
            auto panel =
                std::find_if(panels.begin(), panels.end(), [&](const auto& p) { return p.first == title; });
            if (panel == panels.end()) panel = panels.insert(panel, {title, {}});
            panel->second.push_back(cell);
        }
        if (panels.empty()) panels.push_back({});
        std::vector<Subject> subjects;
        for (const std::string& name : spec_.kind == PlotKind::over_parameter ? spec_.figures : spec_.series)
            for (const auto& [title, cells] : panels) subjects.push_back({name, title, cells});
        return subjects;
    }

    report::Panel panelOf(const Subject& subject) const {
        switch (spec_.kind) {
            case PlotKind::over_parameter:
                return overParameter(subject);
            case PlotKind::against:
                return against(subject);
            case PlotKind::over_time:
                return overTime(subject);
            case PlotKind::bands:
                return bands(subject);
            case PlotKind::one_run:
                break;  // makeFigure's
        }
        return {};
    }

    /// Source and point of the scenario's grid, where there are several.
    std::string titleOf(const Cell& cell) const {
        std::vector<std::string> parts;
        if (spec_.selection.sources.size() > 1) parts.push_back(analysis().label(cell.source));
        addAssignments(parts, findings_.study.scenario_grid, cell.scenario_point);
        return fmt::format("{}", fmt::join(parts, ", "));
    }

    /// A line's name: the config and the point of its grid.
    std::string labelOf(const Cell& cell) const {
        std::vector<std::string> parts = {analysis().label(cell.variant)};
        addAssignments(parts, findings_.study.config_grid, cell.config_point);
        return fmt::format("{}", fmt::join(parts, ", "));
    }

    /// One label looks the same in all panels, whatever else they show.
    report::SeriesStyle styleOf(const std::string& label) const {
        const auto found = std::find(labels_.begin(), labels_.end(), label);
        return report::seriesStyle(static_cast<std::size_t>(found - labels_.begin()));
    }

    /// Without the parameter along the axis.
    void addAssignments(std::vector<std::string>& parts, const std::vector<GridPoint>& grid,
                        const GridPoint& point) const {
        for (const std::string& address : variedAddresses(grid))
            if (address != spec_.parameter)
                parts.push_back(assignmentText(analysis().label(address), valueAt(point, address)));
    }

    double parameterOf(const Cell& cell) const {
        std::string value = valueAt(cell.scenario_point, spec_.parameter);
        if (value.empty()) value = valueAt(cell.config_point, spec_.parameter);
        return numberFromText(value).value_or(Statistic::none);
    }

    Statistic statisticOfCell(const Cell& cell, const std::string& figure) const {
        return scaled(statisticOf(figureOf(cell, figure)), analysis().factor(figure));
    }
    double shownOf(const Statistic& s) const { return ofMedians() ? s.median : s.mean; }

    report::Panel overParameter(const Subject& subject) const {
        Curves curves;
        for (const Cell& cell : subject.cells)
            curves.add(labelOf(cell), parameterOf(cell), statisticOfCell(cell, subject.name));
        spreadAlongX(curves);
        return panelOf(curves, spec_.parameter);
    }

    /// Curves often have their points at the same places: a little apart, their intervals can be told from
    /// each other.
    void spreadAlongX(Curves& curves) const {
        const auto place = [&](double x) { return spec_.logarithmic_x ? std::log(x) : x; };
        std::set<double> places;
        for (const auto& [label, points] : curves.points)
            for (const auto& [x, s] : points) places.insert(place(x));
        const double count = static_cast<double>(curves.labels.size());
        if (places.size() < 2 || count < 2 || !std::isfinite(*places.begin())) return;
        const double extent = *places.rbegin() - *places.begin();
        double gap = extent;
        for (auto next = std::next(places.begin()); next != places.end(); ++next)
            gap = std::min(gap, *next - *std::prev(next));
        const double step = std::min(0.016 * extent, 0.4 * gap / count);
        for (std::size_t i = 0; i < curves.labels.size(); ++i) {
            const double shift = step * (static_cast<double>(i) - (count - 1) / 2);
            std::multimap<double, Statistic> shifted;
            for (const auto& [x, s] : curves.points[curves.labels[i]])
                shifted.emplace(spec_.logarithmic_x ? x * std::exp(shift) : x + shift, s);
            curves.points[curves.labels[i]] = shifted;
        }
    }

    /// A point for each cell; the interval is that along y.
    report::Panel against(const Subject& subject) const {
        Curves curves;
        for (const Cell& cell : subject.cells)
            curves.add(labelOf(cell), shownOf(statisticOfCell(cell, spec_.figures[0])),
                       statisticOfCell(cell, spec_.figures[1]));
        spreadAlongX(curves);
        return panelOf(curves, spec_.figures[0]);
    }

    report::Panel panelOf(const Curves& curves, const std::string& along_x) const {
        report::Panel panel;
        panel.x.label = analysis().label(along_x);
        bool intervals = false;
        for (std::size_t i = 0; i < curves.labels.size(); ++i) {
            const report::SeriesStyle style = styleOf(curves.labels[i]);
            report::Line line{curves.labels[i], {}, style.colour, 1.5, style.dash};
            for (const auto& [x, s] : curves.points.at(curves.labels[i])) {
                const double y = shownOf(s);
                const double low = ofMedians() ? s.median_low : s.mean - s.half_width;
                const double high = ofMedians() ? s.median_high : s.mean + s.half_width;
                line.points.emplace_back(x, y);
                if (!std::isfinite(low)) continue;
                intervals = true;
                panel.layers.push_back(report::Line{
                    "", {{x, shownLow(low, y, spec_.logarithmic_y)}, {x, high}}, style.colour, 1.2});
            }
            panel.layers.push_back(line);
            panel.layers.push_back(report::Points{"", line.points, style.colour, report::Symbol::dot, 6});
        }
        panel.note = fmt::format("{} of {}{}", ofMedians() ? "Median" : "Mean", curves.runs.text(),
                                 intervals ? ", upright lines: 95 % interval" : "");
        return panel;
    }

    report::Panel overTime(const Subject& subject) const {
        report::Panel panel;
        panel.x = report::timeAxis();
        RunCount runs;
        double interval = 0;
        bool shaded = false;
        std::vector<report::Layer> lines;  // above all bands
        for (const Cell& cell : subject.cells) {
            const Course course = courseOf(cell, subject.name);
            if (course.steps.empty()) continue;
            runs.add(course.runs);
            interval = std::max(interval, course.interval);
            const double factor = analysis().factor(subject.name);
            const std::string label = labelOf(cell);
            const report::SeriesStyle style = styleOf(label);
            report::Line line{label, {}, style.colour, 1.5, style.dash};
            report::Band band{"", {}, style.colour, 0.15};
            for (const CourseStep& step : course.steps) {
                const double y = factor * (ofMedians() ? step.median : step.mean);
                line.points.emplace_back(step.seconds, y);
                band.rows.push_back(
                    {step.seconds, shownLow(factor * step.low, y, spec_.logarithmic_y), factor * step.high});
            }
            if (course.runs > 1) panel.layers.push_back(band), shaded = true;
            lines.push_back(line);
        }
        panel.layers.insert(panel.layers.end(), lines.begin(), lines.end());
        panel.note = fmt::format("{} of {}{}", ofMedians() ? "Median" : "Mean", runs.text(),
                                 shaded ? ", shaded: the middle 80 %" : "");
        if (interval > 0) panel.note += fmt::format("; averaged over {:.2g} s", interval);
        return panel;
    }

    report::Panel bands(const Subject& subject) const {
        struct Course {
            std::string label;
            eval::ConsistencyOverRuns consistency;
        };
        std::vector<Course> courses;
        RunCount runs;
        for (const Cell& cell : subject.cells)
            if (const auto measured = consistencyOf(cell, subject.name)) {
                courses.push_back({labelOf(cell), *measured});
                runs.add(measured->runs);
            }

        report::Panel panel;
        panel.x = report::timeAxis();
        if (courses.empty()) return panel;
        // The band depends on the number of runs alone. Where some failed, that of the fullest is shown.
        const auto fullest = std::max_element(
            courses.begin(), courses.end(),
            [](const Course& a, const Course& b) { return a.consistency.runs < b.consistency.runs; });
        report::Band band{"95 % band of consistent runs", {}, colour::grey, 0.3};
        for (const eval::ConsistencyStep& step : fullest->consistency.steps)
            band.rows.push_back({step.stamp.seconds(), step.band.low, step.band.high});
        panel.layers.push_back(band);
        for (std::size_t i = 0; i < courses.size(); ++i) {
            const report::SeriesStyle style = styleOf(courses[i].label);
            report::Line line{courses[i].label, {}, style.colour, 1.2, style.dash};
            for (const eval::ConsistencyStep& step : courses[i].consistency.steps)
                line.points.emplace_back(step.stamp.seconds(), step.mean);
            panel.layers.push_back(line);
        }
        panel.layers.push_back(report::Rule{"expected", fullest->consistency.mean_dimension, false,
                                            colour::text, report::Dash::dotted});
        panel.note = fmt::format("Mean NEES of {}", runs.text());
        return panel;
    }

    const PlotSpec& spec_;
    const Findings& findings_;
    std::vector<std::string> labels_;  ///< of all lines, in the order of their colours
};

report::Figure noteFigure(const PlotSpec& spec, const std::string& note) {
    report::Figure figure;
    figure.title = spec.title;
    figure.panels.emplace_back().note = note;
    return figure;
}

/// A row's or a run's, which did not end `complete`.
std::string noteOf(const std::string& status, const std::string& reason) {
    return fmt::format("the run {}{}{}", status == "failed" ? "" : "is ", status,
                       reason.empty() ? "" : ": " + reason);
}

report::Figure figureOfOneRun(const PlotSpec& spec, const Findings& findings) {
    if (!findings.one_runs) return noteFigure(spec, "no such run");
    const Plan& plan = findings.one_runs->plan();
    const auto index = findRun(plan, {spec.source, spec.config, spec.replicate});
    if (!index) return noteFigure(spec, "no such run");
    const WorldPlan& world = plan.worlds[index->first];
    const std::string key = plan.keyOf(world, plan.runsOf(world)[index->second]);
    const auto row = std::find_if(findings.rows.begin(), findings.rows.end(),
                                  [&](const Row& one) { return one.key == key; });
    const bool has_row = row != findings.rows.end();
    if (has_row && hasFailed(*row)) return noteFigure(spec, noteOf(row->status, row->reason));

    const OneRun& run = findings.one_runs->again(*index);
    if (run.status != "complete") return noteFigure(spec, noteOf(run.status, run.reason));
    report::Figure figure = oneRunFigure(spec, run);
    if (!has_row)
        figure.subtitle = "not among the rows";
    else if (row->estimate_hash != run.estimate_hash)
        figure.subtitle = "not as in the rows: another build";
    return figure;
}

}  // namespace

report::Figure makeFigure(const PlotSpec& spec, const Findings& findings) {
    return spec.kind == PlotKind::one_run ? figureOfOneRun(spec, findings) : Drawing(spec, findings).figure();
}

}  // namespace slamot::study

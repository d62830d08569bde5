#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "MetricRows.h"
#include "TrueOrigin.h"
#include "sections/Courses.h"
#include "slamot/eval/Metrics.h"
#include "slamot/report/Comparison.h"

namespace slamot::report {
namespace {

PageSection tableSection(const std::vector<RunGroup>& groups) {
    PageTable table{"Metrics", {{"", false}}, {}};
    for (const RunGroup& group : groups) {
        const std::size_t count = group.runs.size();
        table.columns.push_back({count > 1 ? fmt::format("{}, {} runs", group.name, count) : group.name});
    }
    TableRow status{{{"status"}}};
    for (const RunGroup& group : groups) {
        status.cells.push_back({statusOf(group)});
    }
    table.rows.push_back(std::move(status));
    std::string heading;
    for (const ComparedMetric& metric : compareMetrics(groups)) {
        if (metric.group != heading) {
            heading = metric.group;
            table.rows.push_back({{{heading}}, true});
        }
        TableRow row{{{metric.heading}}};
        for (const GroupValue& value : metric.values) {
            std::string text = value.count == 0 ? "–" : shortNumber(value.mean);
            if (value.count > 1) {
                text += fmt::format(" ± {:.2g}", value.half_width);
            }
            if (value.count > 0 && value.count < value.of) {
                text += fmt::format(" ({} of {} runs)", value.count, value.of);
            }
            row.cells.push_back({text, value.best});
        }
        table.rows.push_back(std::move(row));
    }
    PageSection section{
        "metrics",
        "Metrics",
        "The best of each row is marked. With several runs: their mean and its 95 % interval "
        "(Student's t). Where "
        "intervals overlap the difference may be chance. Runs that did not come to the end of "
        "their log, or of which one lacks the value, are never the best. Times of single runs are not "
        "compared.",
        {table}};
    for (const std::string& note : comparisonNotes(groups)) {
        section.blocks.push_back(Paragraph{note});
    }
    return section;
}

PageTable settingTable(const std::vector<RunGroup>& groups) {
    PageTable table{"Settings that differ", {{"", false}}, {}};
    for (const RunGroup& group : groups) {
        table.columns.push_back({group.name});
    }
    std::string section;
    for (const ComparedSetting& setting : compareSettings(groups)) {
        if (setting.section != section) {
            section = setting.section;
            table.rows.push_back({{{fmt::format("[{}]", section)}}, true});
        }
        TableRow row{{{setting.key}}};
        for (const std::string& value : setting.values) {
            row.cells.push_back({value.empty() ? "–" : value});
        }
        table.rows.push_back(std::move(row));
    }
    return table;
}

/// Every run of every group as a line; the first of a group names it. Those drawn first are wider, so that
/// what later ones cover is seen.
template <class PointsOf>
std::vector<Layer> linesOf(const std::vector<RunGroup>& groups, PointsOf points_of) {
    std::vector<Layer> lines;
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const SeriesStyle style = seriesStyle(g);
        const double width = 1.3 + std::min(1.2 * static_cast<double>(groups.size() - 1 - g), 3.6);
        bool first = true;
        for (const RunFolder& run : groups[g].runs) {
            Points2 points = points_of(run);
            if (!points.empty()) {
                lines.push_back(Line{first ? groups[g].name : "", std::move(points), style.colour,
                                     first ? width : 0.8, style.dash, first ? 1.0 : 0.5});
                first = false;
            }
        }
    }
    return lines;
}

/// A section of one panel, unless no run has anything to show.
template <class PointsOf>
void addCourse(Page& page, const std::vector<RunGroup>& groups, const std::string& id,
               const std::string& title, const std::string& about, Panel panel, PointsOf points_of) {
    std::vector<Layer> lines = linesOf(groups, points_of);
    if (lines.empty()) {
        return;
    }
    panel.layers.insert(panel.layers.end(), lines.begin(), lines.end());
    Figure figure;
    figure.panels = {std::move(panel)};
    page.sections.push_back(
        {id, title, about, {PageFigure{id, title + " of the compared runs.", figure, ""}}});
}

Panel coursePanel(const std::string& label, const std::string& unit, bool logarithmic) {
    Panel panel;
    panel.x = timeAxis("Time since the start");
    panel.x.min = 0;
    panel.y.label = label;
    panel.y.unit = unit;
    panel.y.logarithmic = logarithmic;
    if (!logarithmic) {
        panel.y.min = 0;
    }
    return panel;
}

Points2 pairedCourse(const RunFolder& run, const std::vector<double>& values) {
    ErrorCourse course;
    for (std::size_t i = 0; i < run.pairs.size(); ++i) {
        course.add(run.seconds(run.pairs[i].stamp), values[i], 0);
    }
    breakAtGaps(course);
    return series(course.seconds, course.error);
}

Points2 positionError(const RunFolder& run) {
    std::vector<double> errors;
    for (const eval::PosePair& pair : run.pairs) {
        errors.push_back((pair.estimate.mean.position() - pair.truth.position()).norm());
    }
    return pairedCourse(run, errors);
}

Points2 robotNees(const RunFolder& run) {
    std::vector<double> values;
    for (const eval::NeesStep& step : eval::robotNees(run.pairs)) {
        values.push_back(step.squared.dimension > 0 ? step.squared.value / step.squared.dimension
                                                    : std::nan(""));
    }
    const bool any = std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    return any ? pairedCourse(run, values) : Points2();
}

Points2 landmarkCount(const RunFolder& run) {
    Points2 points;
    for (const StepRow& step : run.steps) {
        points.emplace_back(run.seconds(step.stamp), static_cast<double>(step.landmarks));
    }
    return points;
}

Points2 stepTime(const RunFolder& run) {
    const Windows windows(run, 100);
    std::vector<std::vector<double>> times(windows.count());
    double pending = 0;
    for (const StepRow& row : run.steps) {
        pending += row.predict_ms + row.detect_ms + row.update_ms;
        if (row.update_ms > 0) {
            times[windows.of(row.stamp)].push_back(pending);
            pending = 0;
        }
    }
    Points2 points;
    for (std::size_t w = 0; w < windows.count(); ++w) {
        if (!times[w].empty()) {
            points.emplace_back(windows.middle(w), quantile(times[w], 0.5));
        }
    }
    return points;
}

Panel waysPanel(const std::vector<RunGroup>& groups) {
    Panel panel;
    panel.x.label = "x";
    panel.y.label = "y";
    panel.x.unit = panel.y.unit = "m";
    panel.equal_aspect = true;
    panel.height = 480;
    panel.legend = LegendPlace::right;
    std::set<std::string> logs;
    for (const RunGroup& group : groups) {
        for (const RunFolder& run : group.runs) {
            if (run.pairs.empty() || !logs.insert(run.log_file).second) {
                continue;
            }
            Line truth{logs.size() == 1 ? "true way" : "", {}, colour::grey, 7, Dash::solid, 0.35};
            for (const eval::PosePair& pair : run.pairs) {
                truth.points.push_back(
                    trueOrigin(pair.truth.position(), run.truth->point, pair.estimate.mean.theta));
            }
            panel.layers.push_back(std::move(truth));
        }
    }
    return panel;
}

Points2 way(const RunFolder& run) {
    Points2 points;
    for (const eval::RobotRow& row : run.run.trajectory) {
        points.push_back(row.robot.mean.position());
    }
    return points;
}

}  // namespace

Page comparisonPage(const std::vector<RunGroup>& groups) {
    std::size_t runs = 0;
    std::string names;
    for (const RunGroup& group : groups) {
        runs += group.runs.size();
        names += (names.empty() ? "" : ", ") + group.name;
    }
    Page page;
    page.title = "Comparison of runs";
    page.subtitle = fmt::format("{} runs of {} configurations: {}", runs, groups.size(), names);
    page.sections.push_back(tableSection(groups));
    addCourse(page, groups, "ways", "Ways of the robot", "In the world's frame, unaligned.",
              waysPanel(groups), way);
    addCourse(page, groups, "position_error", "Position error",
              "The robot's distance from its true position, unaligned.",
              coursePanel("Position error", "m", false), positionError);
    Panel nees = coursePanel("NEES per degree of freedom", "", true);
    nees.layers.push_back(Rule{"covariances that tell the truth", 1});
    addCourse(page, groups, "nees", "NEES of the robot", "Above 1 the estimate is surer than it may be.",
              nees, robotNees);
    addCourse(page, groups, "landmark_count", "Number of landmarks", "", coursePanel("Landmarks", "", false),
              landmarkCount);
    addCourse(page, groups, "step_time", "Step time", "Median within a hundredth of the run.",
              coursePanel("Time of a step", "ms", true), stepTime);
    PageTable table{
        "Runs", {{"folder", false}, {"status", false}, {"estimator", false}, {"log", false}, {"seed"}}, {}};
    for (const RunGroup& group : groups) {
        table.rows.push_back({{{group.name}}, true});
        for (const RunFolder& run : group.runs) {
            table.rows.push_back({{{run.folder},
                                   {run.text("status")},
                                   {run.text("estimator")},
                                   {run.text("log")},
                                   {run.digits("seed")}}});
        }
    }
    PageSection configurations{"runs", "What was compared", "", {table}};
    if (PageTable settings = settingTable(groups); !settings.rows.empty()) {
        configurations.about = "A setting that was not given (–) has its default; `slamot config` prints it.";
        configurations.blocks.push_back(std::move(settings));
    }
    for (const RunGroup& group : groups) {
        configurations.blocks.push_back(
            Verbatim{group.runs.front().text("config"), "Settings of " + group.name, true});
    }
    page.sections.push_back(configurations);
    page.footer = fmt::format("Made by slamot {} from the files of the runs.",
                              groups.front().runs.front().text("version"));
    return page;
}

}  // namespace slamot::report

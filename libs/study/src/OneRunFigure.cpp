#include "OneRunFigure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "slamot/core/data/Angle.h"
#include "slamot/eval/Trajectory.h"
#include "slamot/report/Overview.h"

namespace slamot::study {
namespace {

namespace colour = report::colour;
using report::Panel;

constexpr int robot_dimensions = 3, track_dimensions = 6;
constexpr double error_height = 170, path_width = 800;             // of plotting areas, pixels
constexpr double correlation_size = 560, correlation_width = 718;  // square beside its colour bar

/// What an error panel shows: estimate minus truth and the estimate's standard deviation.
struct ErrorCourse {
    std::string label, unit;
    std::vector<double> seconds, error, sigma;
};

Panel panelOf(const ErrorCourse& course) {
    Panel panel;
    panel.x = report::timeAxis();
    panel.y.label = course.label;
    panel.y.unit = course.unit;
    panel.height = error_height;
    panel.layers.push_back(report::Band{"±3σ", report::sigmaBand(course.seconds, course.sigma)});
    panel.layers.push_back(report::Line{"estimate - truth", report::series(course.seconds, course.error)});
    return panel;
}

/// True and estimated way.
struct Ways {
    report::Points2 estimated, true_ones;
};

Panel panelOf(const Ways& ways, const std::string& what, const char* colour) {
    Panel panel;
    if (ways.estimated.empty()) {
        panel.note = fmt::format("the {} has no estimate where truth is known", what);
        return panel;
    }
    panel.x.label = "x";
    panel.y.label = "y";
    panel.x.unit = panel.y.unit = "m";
    panel.equal_aspect = true;
    Eigen::Vector2d low = ways.estimated.front(), high = low;
    for (const auto* points : {&ways.estimated, &ways.true_ones})
        for (const Eigen::Vector2d& point : *points) {
            low = low.cwiseMin(point);
            high = high.cwiseMax(point);
        }
    const Eigen::Vector2d extent = high - low;
    panel.height = std::clamp(1.1 * path_width * extent.y() / std::max(extent.x(), 1e-3), 200.0, 500.0);
    panel.layers.push_back(
        report::Line{what + ", true", ways.true_ones, colour, 5, report::Dash::solid, 0.35});
    panel.layers.push_back(report::Line{what + ", estimated", ways.estimated, colour, 1.6});
    panel.layers.push_back(
        report::Points{"start", {ways.estimated.front()}, colour, report::Symbol::square, 10, 1, true});
    panel.layers.push_back(
        report::Points{"end", {ways.estimated.back()}, colour, report::Symbol::dot, 8, 1, true});
    return panel;
}

Panel emptyPanel(const std::string& note) {
    Panel panel;
    panel.note = note;
    return panel;
}

std::vector<Panel> mapPanels(const OneRun& run) {
    report::Figure figure = report::overviewFigure(run.record, run.truth ? &*run.truth : nullptr);
    Panel map = figure.panels.front();
    map.note = figure.subtitle + (map.note.empty() ? "" : "; " + map.note);
    return {map};
}

std::vector<Panel> robotPanels(const OneRun& run) {
    Ways ways;
    ErrorCourse x{"error in x", "m", {}, {}, {}}, y{"error in y", "m", {}, {}, {}},
        heading{"error of heading", "rad", {}, {}, {}};
    for (const auto& [stamp, estimate, truth] : eval::pairWithTruth(run.record.trajectory, *run.truth).pairs) {
        const Pose2& mean = estimate.mean;
        ways.estimated.push_back(mean.position());
        ways.true_ones.push_back(truth.position());
        const double errors[] = {mean.x - truth.x, mean.y - truth.y, angleDifference(mean.theta, truth.theta)};
        ErrorCourse* courses[] = {&x, &y, &heading};
        for (int k = 0; k < 3; ++k) {
            courses[k]->seconds.push_back(secondsBetween(run.record.trajectory.front().stamp, stamp));
            courses[k]->error.push_back(errors[k]);
            courses[k]->sigma.push_back(std::sqrt(estimate.covariance(k, k)));
        }
    }
    return {panelOf(ways, "robot", colour::blue), panelOf(x), panelOf(y), panelOf(heading)};
}

/// Of the object of lowest id.
std::vector<Panel> targetPanels(const OneRun& run) {
    if (run.truth->targets.empty()) return {emptyPanel("the log has no moving object")};
    const SourceId id = run.truth->targets.begin()->first;
    Ways ways;
    ErrorCourse x{"error in x", "m", {}, {}, {}}, y{"error in y", "m", {}, {}, {}};
    for (const auto& [stamp, tracks] : run.record.tracks)
        for (const TrackEstimate& track : tracks) {
            const auto truth = run.truth->targetAt(id, stamp);
            if (track.source != id || !truth) continue;
            ways.estimated.push_back(track.mean.head<2>());
            ways.true_ones.push_back(truth->position);
            ErrorCourse* courses[] = {&x, &y};
            for (int k = 0; k < 2; ++k) {
                courses[k]->seconds.push_back(secondsBetween(run.record.trajectory.front().stamp, stamp));
                courses[k]->error.push_back(track.mean(k) - truth->position(k));
                courses[k]->sigma.push_back(std::sqrt(track.covariance(k, k)));
            }
        }
    return {panelOf(ways, "target", colour::vermillion), panelOf(x), panelOf(y)};
}

/// Seven landmarks, as paper 1's figure 7: those detected most often, in each seventh of the order of their
/// first sight. A dot stands at the first sight; the last point is the end of the run.
std::vector<Panel> landmarkPanels(const OneRun& run) {
    constexpr std::size_t shown = 7;
    const auto& landmarks = run.record.landmarks;
    const Stamp start = run.record.trajectory.front().stamp, end = run.record.trajectory.back().stamp;
    Panel panel;
    panel.x = report::timeAxis();
    panel.y.label = "distance from the true position";
    panel.y.unit = "m";
    panel.y.min = 0;
    panel.height = 300;
    report::Points2 first_sights;
    for (std::size_t part = 0; part < shown; ++part) {
        const auto from = landmarks.begin() + static_cast<std::ptrdiff_t>(part * landmarks.size() / shown);
        const auto to =
            landmarks.begin() + static_cast<std::ptrdiff_t>((part + 1) * landmarks.size() / shown);
        const auto most =
            std::max_element(from, to, [](const auto& a, const auto& b) { return a.seen < b.seen; });
        if (most == to) continue;
        const auto place = run.truth->landmarks.find(most->source);
        if (place == run.truth->landmarks.end()) continue;
        const report::SeriesStyle style = report::seriesStyle(part);
        report::Line line{fmt::format("landmark {}", most->source.value), {}, style.colour, 1.5, style.dash};
        const auto add = [&](Stamp stamp, const Vector2& mean) {
            line.points.emplace_back(secondsBetween(start, stamp), (mean - place->second).norm());
        };
        for (const LandmarkSight& sight : run.sights)
            if (sight.landmark.id == most->id) add(sight.stamp, sight.landmark.mean);
        add(end, most->mean);
        first_sights.push_back(line.points.front());
        panel.layers.push_back(line);
    }
    panel.layers.push_back(
        report::Points{"first sight", first_sights, colour::black, report::Symbol::dot, 7});
    panel.note = fmt::format("{} of {} landmarks: of each seventh, by first sight, the one seen most often.",
                             first_sights.size(), landmarks.size());
    return {panel};
}

/// Row 0 at the top, as matrices are written. NaN where a component is certain.
report::HeatMap heatMapOf(const JointCovariance& joint, int rows, int columns) {
    const Eigen::VectorXd sigma = joint.matrix.diagonal().cwiseSqrt();
    const Eigen::MatrixXd r = joint.matrix.cwiseQuotient(sigma * sigma.transpose());
    report::HeatMap map;
    map.values = r.topLeftCorner(rows, columns).colwise().reverse();
    map.x_min = map.y_min = -0.5;
    map.x_max = columns - 0.5;
    map.y_max = rows - 0.5;
    return map;
}

/// Rules before these columns and rows.
void addBorders(Panel& panel, int rows, const std::vector<int>& places) {
    for (const int place : places) {
        panel.layers.push_back(
            report::Rule{"", place - 0.5, true, colour::vermillion, report::Dash::solid, 1});
        if (place < rows)
            panel.layers.push_back(
                report::Rule{"", rows - place - 0.5, false, colour::vermillion, report::Dash::solid, 1});
    }
}

/// One name for each column, and for each row from the bottom.
void nameCells(Panel& panel, int rows, const std::vector<std::string>& names) {
    panel.x.categories = names;
    panel.y.categories = {names.begin(), names.begin() + rows};
    std::reverse(panel.y.categories.begin(), panel.y.categories.end());
    panel.x.min = panel.y.min = -0.5;
    panel.x.max = static_cast<double>(names.size()) - 0.5;
    panel.y.max = rows - 0.5;
}

int firstLandmarkRow(const JointCovariance& joint) {
    return robot_dimensions + track_dimensions * static_cast<int>(joint.tracks.size());
}

/// Absolute values: whether x and y of two landmarks err to one side says only where the robot stood.
std::vector<Panel> correlationPanels(const OneRun& run) {
    constexpr double young_age = 5;  // [s]
    const JointCovariance& joint = run.joint;
    const Stamp end = run.record.trajectory.back().stamp;
    std::set<LandmarkId> young_ones;
    for (const LandmarkEstimate& l : run.record.landmarks)
        if (secondsBetween(l.first_seen, end) < young_age) young_ones.insert(l.id);
    // Landmarks stand in the order of their first sight: the young ones are last.
    const auto young = std::count_if(joint.landmarks.begin(), joint.landmarks.end(),
                                     [&](LandmarkId id) { return young_ones.count(id) > 0; });
    const int all = static_cast<int>(joint.matrix.rows()), landmarks = firstLandmarkRow(joint),
              young_row = all - 2 * static_cast<int>(young);

    Panel panel;
    std::vector<std::string> names(static_cast<std::size_t>(all));
    const auto name = [&](int from, int to, const char* what) {
        if (to > from) names[static_cast<std::size_t>((from + to) / 2)] = what;
    };
    const bool has_target = !joint.tracks.empty();
    name(0, landmarks, has_target ? "robot, target" : "robot");
    name(landmarks, young_row, "landmarks");
    name(young_row, all, "young");
    nameCells(panel, all, names);
    for (std::string& row : panel.y.categories)
        if (row == names[static_cast<std::size_t>(landmarks / 2)]) row.clear();  // no room beside the axis
    panel.y.categories.back() = "robot";
    if (has_target) panel.y.categories[static_cast<std::size_t>(all - landmarks)] = "target";
    panel.height = correlation_size;
    report::HeatMap map = heatMapOf(joint, all, all);
    map.values = map.values.cwiseAbs();
    map.label = "|correlation|";
    map.colours = report::ColourMap::grey;
    panel.layers.push_back(map);
    addBorders(panel, all, {landmarks, young_row});
    panel.note = fmt::format("{} components; {} landmarks, {} of them first seen in the last {} s (young).",
                             all, joint.landmarks.size(), young, young_age);
    return {panel};
}

/// Robot and targets against themselves and the first landmarks.
std::vector<Panel> correlationHeadPanels(const OneRun& run) {
    const JointCovariance& joint = run.joint;
    const int rows = firstLandmarkRow(joint);
    const int columns = static_cast<int>(std::min<Eigen::Index>(joint.matrix.cols(), rows + 20));
    std::vector<std::string> names = {"x", "y", "θ"};
    for (std::size_t t = 0; t < joint.tracks.size(); ++t)
        for (const char* component : {"px", "py", "vx", "vy", "ax", "ay"}) names.emplace_back(component);
    for (int i = 0; rows + 2 * i < columns; ++i)
        for (const char* axis : {"x", "y"}) names.push_back(fmt::format("{}{}", axis, i + 1));
    Panel panel;
    nameCells(panel, rows, names);
    panel.x.label =
        joint.tracks.empty() ? "robot, the first ten landmarks" : "robot, target, the first ten landmarks";
    panel.height = 24.0 * rows;
    report::HeatMap map = heatMapOf(joint, rows, columns);
    map.label = "correlation";
    map.low = -1;
    map.colours = report::ColourMap::diverging;
    panel.layers.push_back(map);
    addBorders(panel, rows, {robot_dimensions, rows});
    return {panel};
}

}  // namespace

report::Figure oneRunFigure(const PlotSpec& spec, const OneRun& run) {
    using Draw = std::vector<Panel> (*)(const OneRun&);
    struct Kind {
        Draw draw;
        bool needs_truth, needs_joint;
    };
    static const std::map<OneRunShow, Kind> kinds = {
        {OneRunShow::map, {mapPanels, false, false}},
        {OneRunShow::robot, {robotPanels, true, false}},
        {OneRunShow::target, {targetPanels, true, false}},
        {OneRunShow::landmark_errors, {landmarkPanels, true, false}},
        {OneRunShow::correlation, {correlationPanels, false, true}},
        {OneRunShow::correlation_head, {correlationHeadPanels, false, true}}};
    const Kind& kind = kinds.at(spec.show);
    report::Figure figure;
    figure.title = spec.title;
    if (run.record.trajectory.empty())
        figure.panels = {emptyPanel("the run has no step")};
    else if (kind.needs_truth && !run.truth)
        figure.panels = {emptyPanel("the log has no truth")};
    else if (kind.needs_joint && run.joint.matrix.size() == 0)
        figure.panels = {emptyPanel("the estimator has no joint covariance")};
    else
        figure.panels = kind.draw(run);
    if (spec.show == OneRunShow::correlation) figure.width = correlation_width;
    return figure;
}

}  // namespace slamot::study

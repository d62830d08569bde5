// Normalized estimation error squared of the robot and of tracks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "MetricRows.h"
#include "sections/Courses.h"
#include "sections/Sections.h"
#include "slamot/eval/Metrics.h"

namespace slamot::report {
namespace section_nees {

/// A logarithmic panel with the chi-square band of `degrees`.
Panel neesPanel(const RunFolder& run, const std::string& title, int degrees, Line line) {
    const double probability = run.evaluation.probability;
    const eval::Band band = eval::chiSquareBand(probability, degrees);
    Panel panel;
    panel.title = title;
    panel.x = runTimeAxis(run);
    panel.y.label = "NEES";
    panel.y.logarithmic = true;
    panel.height = 170;
    double least = band.low;
    for (const Eigen::Vector2d& p : line.points) {
        least = p.y() > 0 ? std::min(least, p.y()) : least;
    }
    panel.y.min = std::max(least, 0.05 * band.low);  // single lucky steps would stretch the axis without end
    const double end = run.duration();
    panel.layers.push_back(
        Band{fmt::format("{:.0f} % of χ² with {} degrees of freedom", 100 * probability, degrees),
             {{0, band.low, band.high}, {end, band.low, band.high}},
             colour::green,
             0.2});
    panel.layers.push_back(Rule{"its mean", static_cast<double>(degrees), false, colour::green});
    panel.layers.push_back(std::move(line));
    return panel;
}

int mostDegrees(const eval::NeesSeries& series) {
    int degrees = 0;
    for (const eval::NeesStep& step : series) {
        degrees = std::max(degrees, step.squared.dimension);
    }
    return degrees;
}

Line lineOf(const RunFolder& run, const eval::NeesSeries& series, const std::string& label,
            const std::string& colour) {
    ErrorCourse course;
    for (const eval::NeesStep& step : series) {
        course.add(run.seconds(step.stamp), step.squared.dimension > 0 ? step.squared.value : std::nan(""),
                   0);
    }
    breakAtGaps(course);
    return {label, report::series(course.seconds, course.error), colour, 1.2};
}

/// Of the position, 2 degrees of freedom.
eval::NeesSeries objectNees(const RunFolder& run, const FollowedObject& object) {
    eval::NeesSeries series;
    for (const auto& [stamp, tracks] : run.run.tracks) {
        const TrackEstimate* track = object.among(tracks);
        if (const auto truth = track ? truthOf(run, object.source, stamp) : std::nullopt) {
            const Vector2 error = track->mean.head<2>() - truth->position;
            const Matrix2 covariance = track->covariance.topLeftCorner<2, 2>();
            series.push_back({stamp, eval::nees(error, covariance)});
        }
    }
    return series;
}

std::string absent(const RunFolder& run) {
    if (!run.truth) {
        return "no truth: " + run.why_no_truth;
    }
    return mostDegrees(eval::robotNees(run.pairs)) == 0 ? "no covariance that is known has a truth" : "";
}

/// NEES takes truth for exact.
std::string howWellTruthIsKnown(const Truth& truth) {
    if (truth.position_std > 0) {
        return fmt::format(
            " Truth itself has a standard deviation of {} m, which NEES takes for 0: it is too large by "
            "that.",
            truth.position_std);
    }
    const bool measured =
        !truth.point.isZero(0) || std::all_of(truth.robot.begin(), truth.robot.end(),
                                              [](const TruePose& p) { return std::isnan(p.pose.theta); });
    return measured ? " This truth was measured (of a point of the robot, or without headings) and states no "
                      "accuracy, "
                      "while NEES takes it for exact: errors of the truth count as the estimate's, and NEES "
                      "may be far "
                      "too large."
                    : "";
}

std::vector<Block> blocks(const RunFolder& run) {
    const eval::NeesSeries robot = eval::robotNees(run.pairs);
    Figure figure;
    figure.panels.push_back(
        neesPanel(run, "Robot", mostDegrees(robot), lineOf(run, robot, "Robot", colour::blue)));
    std::size_t objects = 0, shown = 0;
    for (const FollowedObject& object : followedObjects(run.run)) {
        const eval::NeesSeries series = objectNees(run, object);
        if (series.empty()) {
            continue;
        }
        ++objects;
        if (shown == most_objects_shown) {
            continue;
        }
        ++shown;
        Panel panel =
            neesPanel(run, object.name + ", position", 2, lineOf(run, series, "Track", object.style.colour));
        panel.height = 140;
        figure.panels.push_back(std::move(panel));
    }
    std::string caption;
    if (const auto summary = eval::summariseNees(robot, run.evaluation.probability)) {
        caption = fmt::format(
            "Robot: {} on average of {:.3g} degrees of freedom; {:.1f} % of {} steps in the band.",
            shortNumber(summary->average), summary->mean_dimension, 100 * summary->inside, summary->steps);
    }
    if (objects > shown) {
        caption += fmt::format(" The {} longest followed of {} objects.", shown, objects);
    }
    caption += howWellTruthIsKnown(*run.truth);
    return {PageFigure{"nees", "NEES over time with chi-square bands. " + caption, figure, caption}};
}

}  // namespace section_nees

const ReportSection nees_section{
    "nees", "NEES",
    "Do the covariances tell the truth? The squared error weighted by its inverse covariance: above the band "
    "the estimate is surer "
    "than it may be, below it is too careful. Steps of one run depend on each other: "
    "one run leaves the band for a while by chance; a study over many seeds decides.",
    section_nees::absent, section_nees::blocks};

}  // namespace slamot::report

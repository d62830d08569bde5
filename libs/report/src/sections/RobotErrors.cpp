// The robot's error in each state, with its bounds.
#include <fmt/format.h>

#include <cmath>

#include "sections/Courses.h"
#include "sections/Sections.h"
#include "slamot/core/data/Angle.h"

namespace slamot::report {
namespace section_robot_errors {

std::string absent(const RunFolder& run) {
    return !run.truth          ? "no truth: " + run.why_no_truth
           : run.pairs.empty() ? "truth knows the robot at none of the run's stamps"
                               : "";
}

std::vector<Block> blocks(const RunFolder& run) {
    constexpr double degrees = 180 / pi;
    ErrorCourse x, y, heading;
    bool heading_known = false;
    for (const auto& [stamp, estimate, truth] : run.pairs) {
        const double t = run.seconds(stamp);
        const auto sigma = [c = estimate.covariance](int i) { return std::sqrt(std::max(0.0, c(i, i))); };
        x.add(t, estimate.mean.x - truth.x, sigma(0));
        y.add(t, estimate.mean.y - truth.y, sigma(1));
        const double error =
            std::isfinite(truth.theta) ? angleDifference(estimate.mean.theta, truth.theta) : truth.theta;
        heading.add(t, degrees * error, degrees * sigma(2));
        heading_known = heading_known || std::isfinite(error);
    }
    for (ErrorCourse* course : {&x, &y, &heading}) {
        breakAtGaps(*course);
    }
    Figure figure;
    figure.shared_legend = true;
    figure.panels = {errorPanel(run, "Error in x", "m", x, colour::blue),
                     errorPanel(run, "Error in y", "m", y, colour::blue)};
    if (heading_known) {
        figure.panels.push_back(errorPanel(run, "Error of heading", "°", heading, colour::blue));
    }
    for (Panel& panel : figure.panels) {
        panel.legend = LegendPlace::none;
    }
    std::string parts =
        fmt::format("x {:.1f} %, y {:.1f} %", partWithinThreeSigma(x), partWithinThreeSigma(y));
    if (heading_known) {
        parts += fmt::format(", heading {:.1f} %", partWithinThreeSigma(heading));
    }
    std::string caption = fmt::format(
        "Within three standard deviations: {}; 99.7 % where errors are Gaussian of that size.", parts);
    if (run.truth->position_std > 0) {
        caption += fmt::format(" Truth itself has a standard deviation of {} m, which the bounds leave out.",
                               run.truth->position_std);
    }
    return {PageFigure{"robot_errors", "The robot's errors in x, y and heading over time. " + caption, figure,
                       caption}};
}

}  // namespace section_robot_errors

const ReportSection robot_error_section{
    "robot-errors", "Robot errors",
    "Estimate minus truth, in the world's axes, unaligned, with a band of three standard "
    "deviations of the estimate.",
    section_robot_errors::absent, section_robot_errors::blocks};

}  // namespace slamot::report

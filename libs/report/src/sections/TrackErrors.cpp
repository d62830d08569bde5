// Errors of tracks whose object the log names.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sections/Courses.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace section_track_errors {

/// Errors in x, y and in the velocities along them, at every stamp of the run; NaN where the object has no
/// track.
std::array<ErrorCourse, 4> coursesOf(const RunFolder& run, const FollowedObject& object) {
    std::array<ErrorCourse, 4> courses;
    for (const eval::RobotRow& row : run.run.trajectory) {
        const auto present = run.run.tracks.find(row.stamp);
        const TrackEstimate* estimate =
            present == run.run.tracks.end() ? nullptr : object.among(present->second);
        const auto truth = estimate ? truthOf(run, object.source, row.stamp) : std::nullopt;
        for (int k = 0; k < 4; ++k) {
            const double true_value = !truth  ? std::nan("")
                                      : k < 2 ? truth->position(k)
                                              : truth->velocity(k - 2);
            courses[static_cast<std::size_t>(k)].add(
                run.seconds(row.stamp), estimate ? estimate->mean(k) - true_value : std::nan(""),
                estimate ? std::sqrt(std::max(0.0, estimate->covariance(k, k))) : std::nan(""));
        }
    }
    return courses;
}

std::vector<FollowedObject> objectsWithTruth(const RunFolder& run) {
    std::vector<FollowedObject> objects = followedObjects(run.run);
    objects.erase(
        std::remove_if(objects.begin(), objects.end(),
                       [&](const FollowedObject& o) { return run.truth->targets.count(o.source) == 0; }),
        objects.end());
    return objects;
}

std::string absent(const RunFolder& run) {
    return !run.truth                      ? "no truth: " + run.why_no_truth
           : run.run.tracks.empty()        ? "the run has no track"
           : objectsWithTruth(run).empty() ? "no track has a source id with a truth"
                                           : "";
}

PageFigure figureOf(const RunFolder& run, const FollowedObject& object) {
    const std::array<std::pair<const char*, const char*>, 4> names{{{"Error in x", "m"},
                                                                    {"Error in y", "m"},
                                                                    {"Error of velocity in x", "m/s"},
                                                                    {"Error of velocity in y", "m/s"}}};
    const std::array<ErrorCourse, 4> courses = coursesOf(run, object);
    Figure figure;
    figure.title = object.name;
    figure.columns = 2;
    figure.shared_legend = true;
    std::string parts;
    for (std::size_t k = 0; k < courses.size(); ++k) {
        const auto& errors = courses[k].error;
        if (std::none_of(errors.begin(), errors.end(), [](double e) { return std::isfinite(e); })) {
            continue;  // truth may lack velocities
        }
        const auto& [name, unit] = names[k];
        figure.panels.push_back(errorPanel(run, name, unit, courses[k], object.style.colour));
        figure.panels.back().legend = LegendPlace::none;
        parts += fmt::format("{}{} {:.1f} %", parts.empty() ? "" : ", ", std::string(name).substr(6),
                             partWithinThreeSigma(courses[k]));
    }
    const std::string caption = fmt::format("Within three standard deviations: {}.", parts);
    return {fmt::format("object_{}_errors", object.source.value),
            fmt::format("Errors of {} over time. {}", object.name, caption), figure, caption};
}

std::vector<Block> blocks(const RunFolder& run) {
    std::vector<Block> result;
    const std::vector<FollowedObject> objects = objectsWithTruth(run);
    for (const FollowedObject& object : objects) {
        if (result.size() < most_objects_shown) {
            result.push_back(figureOf(run, object));
        }
    }
    if (objects.size() > result.size()) {
        result.push_back(
            Paragraph{fmt::format("The {} longest followed of {} objects.", result.size(), objects.size())});
    }
    return result;
}

}  // namespace section_track_errors

const ReportSection track_error_section{
    "track-errors", "Track errors",
    "Estimate minus truth in the world's axes, with a band of three standard deviations.",
    section_track_errors::absent, section_track_errors::blocks};

}  // namespace slamot::report

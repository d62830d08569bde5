// Errors of tracks whose object the log names.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "sections/Courses.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace {

struct TrackCourses {
    StyledTrack track;
    ErrorCourse x, y, speed_x, speed_y;
};

std::vector<TrackCourses> coursesOf(const RunFolder& run) {
    std::vector<TrackCourses> shown;
    for (const StyledTrack& track : styledTracks(run.run)) {
        if (track.source.valid() && run.truth->targets.count(track.source) > 0 && shown.size() < most_tracks_shown) {
            shown.push_back({track, {}, {}, {}, {}});
        }
    }
    for (const eval::RobotRow& row : run.run.trajectory) {
        const auto present = run.run.tracks.find(row.stamp);
        const double t = run.seconds(row.stamp);
        for (TrackCourses& courses : shown) {
            const TrackEstimate* estimate = nullptr;
            if (present != run.run.tracks.end()) {
                for (const TrackEstimate& track : present->second) {
                    estimate = track.id == courses.track.id ? &track : estimate;
                }
            }
            const auto truth = estimate ? truthOf(run, courses.track.source, row.stamp) : std::nullopt;
            ErrorCourse* const positions[] = {&courses.x, &courses.y};
            ErrorCourse* const speeds[] = {&courses.speed_x, &courses.speed_y};
            for (int i = 0; i < 2; ++i) {
                const double unknown = std::nan("");
                const auto sigma = [&](int k) { return std::sqrt(std::max(0.0, estimate->covariance(k, k))); };
                positions[i]->add(t, truth ? estimate->mean(i) - truth->position(i) : unknown,
                                  estimate ? sigma(i) : unknown);
                speeds[i]->add(t, truth ? estimate->mean(2 + i) - truth->velocity(i) : unknown,
                               estimate ? sigma(2 + i) : unknown);
            }
        }
    }
    return shown;
}

std::string absent(const RunFolder& run) {
    if (!run.truth) {
        return "no truth: " + run.why_no_truth;
    }
    for (const StyledTrack& track : styledTracks(run.run)) {
        if (track.source.valid() && run.truth->targets.count(track.source) > 0) {
            return {};
        }
    }
    return run.run.tracks.empty() ? "the run has no track" : "no track has a source id with a truth";
}

std::vector<Block> blocks(const RunFolder& run) {
    std::vector<Block> result;
    for (const TrackCourses& courses : coursesOf(run)) {
        const std::string name = nameOf(courses.track), colour = courses.track.style.colour;
        Figure figure;
        figure.title = name;
        figure.columns = 2;
        figure.shared_legend = true;
        figure.panels = {errorPanel(run, "Error in x", "m", courses.x, colour),
                         errorPanel(run, "Error in y", "m", courses.y, colour),
                         errorPanel(run, "Error of velocity in x", "m/s", courses.speed_x, colour),
                         errorPanel(run, "Error of velocity in y", "m/s", courses.speed_y, colour)};
        for (Panel& panel : figure.panels) {
            panel.legend = LegendPlace::none;
        }
        const std::string caption =
            fmt::format("Within three standard deviations: x {:.1f} %, y {:.1f} %, velocity in x {:.1f} %, in y {:.1f} %.",
                        partWithinThreeSigma(courses.x), partWithinThreeSigma(courses.y),
                        partWithinThreeSigma(courses.speed_x), partWithinThreeSigma(courses.speed_y));
        result.push_back(PageFigure{fmt::format("track_{}_errors", courses.track.id.value),
                                    fmt::format("Errors of {} in position and velocity over time. {}", name, caption),
                                    figure, caption});
    }
    const std::size_t all = styledTracks(run.run).size();
    if (all > result.size()) {
        result.push_back(Paragraph{fmt::format("Shown: the {} longest of {} tracks, of those whose object is known.",
                                               result.size(), all)});
    }
    return result;
}

}  // namespace

const ReportSection track_error_section{"track-errors", "Track errors",
                                        "Estimate minus truth in the world's axes, with a band of three standard deviations.",
                                        absent, blocks};

}  // namespace slamot::report

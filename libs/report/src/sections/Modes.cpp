// Probabilities of the modes of motion of each track.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sections/Courses.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace section_modes {

std::string absent(const RunFolder& run) {
    return run.run.tracks.empty()          ? "the run has no track"
           : run.run.mode_names.size() < 2 ? "the estimator has one mode of motion"
                                           : "";
}

/// Strips at the top of the panel wherever truth says which mode the object is in, where it has a mode's
/// name.
void addTrueModes(Panel& panel, const RunFolder& run, const FollowedObject& object) {
    constexpr double height = 1.06;
    if (!run.truth || !object.source.valid()) {
        return;
    }
    const auto truth = run.truth->targets.find(object.source);
    if (truth == run.truth->targets.end()) {
        return;
    }
    for (std::size_t m = 0; m < run.run.mode_names.size(); ++m) {
        Line strip{"", {}, seriesStyle(m).colour, 6, Dash::solid, 0.6};
        for (const TrueTarget& sample : truth->second) {
            const bool here = sample.mode == run.run.mode_names[m];
            strip.points.emplace_back(run.seconds(sample.stamp), here ? height : std::nan(""));
            panel.note = here || !panel.note.empty() ? "The strip at the top is the true mode." : "";
        }
        panel.layers.push_back(std::move(strip));
    }
}

std::vector<Block> blocks(const RunFolder& run) {
    Figure figure;
    figure.shared_legend = true;
    const std::vector<FollowedObject> objects = followedObjects(run.run);
    for (const FollowedObject& object : objects) {
        if (figure.panels.size() == most_objects_shown) {
            break;
        }
        Panel panel;
        panel.title = object.name;
        panel.x = runTimeAxis(run);
        panel.y.label = "Probability";
        panel.y.min = 0;
        panel.y.max = 1.1;
        panel.height = 120;
        panel.legend = LegendPlace::none;
        for (std::size_t m = 0; m < run.run.mode_names.size(); ++m) {
            const SeriesStyle style = seriesStyle(m);
            Line line{
                "mode " + run.run.mode_names[m], {}, style.colour, 1.5, m < 2 ? Dash::solid : Dash::dashed};
            for (const eval::RobotRow& row : run.run.trajectory) {
                const auto present = run.run.tracks.find(row.stamp);
                const TrackEstimate* track =
                    present == run.run.tracks.end() ? nullptr : object.among(present->second);
                line.points.emplace_back(run.seconds(row.stamp),
                                         track ? track->mode_probabilities.at(m) : std::nan(""));
            }
            panel.layers.push_back(std::move(line));
        }
        addTrueModes(panel, run, object);
        figure.panels.push_back(std::move(panel));
    }
    std::string caption;
    if (objects.size() > figure.panels.size()) {
        caption = fmt::format("The {} longest followed of {} objects.", figure.panels.size(), objects.size());
    }
    const std::string alt = fmt::format("Probabilities of {} modes over time, for {} objects.",
                                        run.run.mode_names.size(), figure.panels.size());
    return {PageFigure{"modes", alt, figure, caption}};
}

}  // namespace section_modes

const ReportSection mode_section{"modes", "Mode probabilities", "How each track is taken to move.",
                                 section_modes::absent, section_modes::blocks};

}  // namespace slamot::report

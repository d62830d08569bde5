// The overview figure: map, ways, ellipses, truth.
#include <fmt/format.h>

#include "TrueOrigin.h"
#include "sections/Sections.h"
#include "slamot/report/Overview.h"

namespace slamot::report {
namespace section_map {

std::string absent(const RunFolder& run) {
    return run.run.trajectory.empty() ? "the run has no step" : "";
}

std::vector<Block> blocks(const RunFolder& run) {
    Figure figure = overviewFigure(run.run, run.truth ? &*run.truth : nullptr);
    figure.title.clear();
    figure.panels.resize(1);  // errors have a section of their own
    const std::string alt =
        fmt::format("Map of the run: the robot's way, {} landmarks with 3-sigma ellipses{}.",
                    run.run.landmarks.size(), run.truth ? ", and the true ways and landmarks" : "");
    std::string caption = run.truth ? whereTruthIsDrawn(*run.truth) : "";
    if (run.failed()) {
        caption += " A run that failed leaves no final map; the replay has landmarks as they were last seen.";
    }
    return {PageFigure{"map", alt, figure, caption}};
}

}  // namespace section_map

const ReportSection map_section{
    "map", "Map",
    "Estimates are thin full lines, what is true is the wide pale line of the same colour; "
    "true landmarks are grey crosses. Ellipses are at three standard deviations.",
    section_map::absent, section_map::blocks};

}  // namespace slamot::report

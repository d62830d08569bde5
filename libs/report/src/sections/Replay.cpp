// The run again, with a slider.
#include <fmt/format.h>

#include "TrueOrigin.h"
#include "sections/ReplayData.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace section_replay {

std::string absent(const RunFolder& run) {
    return run.run.trajectory.size() < 2 ? "the run has fewer than two steps" : "";
}

std::vector<Block> blocks(const RunFolder& run) {
    ReplayView replay = replayOf(run);
    replay.alt = fmt::format(
        "Replay of {:.1f} s: the robot and its field of view, landmarks as they appear, tracks with their "
        "modes.",
        run.duration());
    if (run.truth) {
        const std::string where = whereTruthIsDrawn(*run.truth);
        replay.note += (replay.note.empty() || where.empty() ? "" : " ") + where;
    }
    return {replay};
}

}  // namespace section_replay

const ReportSection replay_section{"replay", "Replay",
                                   "Drag the slider, or choose the map and use the arrow keys, Page up and "
                                   "down, Home, End and space; + and - enlarge, 0 "
                                   "shows all. Each landmark is drawn as it was when last seen; one that is "
                                   "not in the map at the end, until then.",
                                   section_replay::absent, section_replay::blocks};

}  // namespace slamot::report

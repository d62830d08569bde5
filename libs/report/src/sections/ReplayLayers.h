#pragma once
#include <vector>

#include "sections/ReplayScene.h"
#include "slamot/report/Page.h"

namespace slamot::report {

/// A layer of the replay. `id` names its drawing in assets/replay_layers.js.
struct ReplayLayer {
    const char* id;
    const char* label;  ///< of its box; empty for what is always shown
    bool on;            ///< at first
    /// What it is drawn from; null where the run has none, and the layer is not there then. No function: a
    /// box that other layers and the replay ask for.
    nlohmann::json (*data)(const ReplayScene&);
    /// The things it draws, for the list below the replay; no function for none.
    std::vector<ReplayKey> (*keys)(const ReplayScene&) = nullptr;
};

/// In the order of drawing.
const std::vector<ReplayLayer>& replayLayers();

}  // namespace slamot::report

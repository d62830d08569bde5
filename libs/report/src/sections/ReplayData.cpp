#include "sections/ReplayData.h"

#include "JsonText.h"
#include "page/CompactSpec.h"
#include "sections/ReplayLayers.h"
#include "slamot/report/Palette.h"

namespace slamot::report {
namespace {

using nlohmann::json;

/// Landmarks in the estimate at each frame; empty where steps.csv is not there.
json landmarkCounts(const ReplayScene& scene) {
    json counts = json::array();
    std::size_t row = 0;
    for (const Stamp stamp : scene.stamps()) {
        while (row + 1 < scene.run.steps.size() && scene.run.steps[row + 1].stamp <= stamp) {
            ++row;
        }
        if (!scene.run.steps.empty()) {
            counts.push_back(scene.run.steps[row].landmarks);
        }
    }
    return counts;
}

}  // namespace

ReplayView replayOf(const RunFolder& run) {
    const ReplayScene scene(run);
    ReplayView replay;
    const MapView& view = scene.view();
    json data = {{"low", {view.low.x(), view.low.y()}}, {"high", {view.high.x(), view.high.y()}}};
    data["colours"] = {{"robot", colour::blue},
                       {"landmark", colour::black},
                       {"trueLandmark", colour::grey},
                       {"sight", colour::sky},
                       {"particle", colour::orange}};
    data["times"] = json::array();
    for (const Stamp stamp : scene.stamps()) {
        data["times"].push_back(rounded(run.seconds(stamp), 3));
    }
    data["modes"] = json::array();
    for (std::size_t m = 0; m < run.run.mode_names.size(); ++m) {
        data["modes"].push_back({{"name", run.run.mode_names[m]}, {"colour", seriesStyle(m).colour}});
    }
    data["landmarkCount"] = landmarkCounts(scene);
    data["layers"] = json::array();
    for (const ReplayLayer& layer : replayLayers()) {
        json layer_data = layer.data ? layer.data(scene) : json();
        if (layer.data && layer_data.is_null()) {
            continue;
        }
        if (*layer.label != '\0') {
            replay.choices.push_back({layer.id, layer.label, layer.on});
        }
        for (const ReplayKey& key : layer.keys ? layer.keys(scene) : std::vector<ReplayKey>()) {
            replay.keys.push_back(key);
        }
        if (layer.data) {
            data["layers"].push_back({{"id", layer.id}, {"data", std::move(layer_data)}});
        }
    }
    replay.data = jsonText(data);
    for (const std::string& cut : scene.cuts()) {
        replay.note += (replay.note.empty() ? "" : " ") + cut;
    }
    return replay;
}

}  // namespace slamot::report

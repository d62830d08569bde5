#include "slamot/report/FigureSpec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "LayerMarks.h"
#include "Legend.h"
#include "PanelSpec.h"
#include "Text.h"

namespace slamot::report {
namespace {

using nlohmann::json;

constexpr double edge = 14;  // white rim, pixels
constexpr double between_rows = 14;

/// Quiet axes: thin grey ticks, pale grid, no heavy frame.
json axisConfig() {
    return {{"labelFont", font},
            {"labelFontSize", label_size},
            {"labelColor", colour::text},
            {"titleFont", font},
            {"titleFontSize", axis_title_size},
            {"titleFontWeight", "normal"},
            {"titleColor", colour::text},
            {"titlePadding", 6},
            {"domain", false},
            {"tickColor", colour::frame},
            {"tickSize", 4},
            {"gridColor", colour::grid},
            {"gridWidth", 1}};
}

json heading(const std::string& text, double y, double size, const char* fill, bool bold, double width) {
    // Bold letters are about an eighth wider.
    const std::string shown = fitText(text, bold ? 1.13 * size : size, width - 2 * edge);
    return {{"type", "text"},
            {"interactive", false},
            {"encode",
             {{"update",
               {{"text", constant(shown)},
                {"x", constant(edge)},
                {"y", constant(y)},
                {"font", constant(font)},
                {"fontSize", constant(size)},
                {"fontWeight", constant(bold ? "bold" : "normal")},
                {"fill", constant(fill)}}}}}};
}

/// Names of layers with the marks that draw them, and how many symbols there are.
json layersMeta(const Figure& figure) {
    json layers = json::array();
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        for (std::size_t j = 0; j < figure.panels[i].layers.size(); ++j) {
            const std::string label = labelOf(figure.panels[i].layers[j]);
            if (label.empty()) {
                continue;
            }
            const auto same = std::find_if(layers.begin(), layers.end(),
                                           [&](const json& layer) { return layer["label"] == label; });
            json& layer = same == layers.end() ? layers.emplace_back() : *same;
            layer["label"] = label;
            layer["marks"].push_back(fmt::format("mark_p{}_l{}", i, j));
        }
    }
    return layers;
}

}  // namespace

json figureSpec(const Figure& figure) {
    json data = json::array(), marks = json::array(), panels = json::array();
    double y = edge;
    if (!figure.title.empty()) {
        marks.push_back(
            heading(figure.title, y + title_size - 2, title_size, colour::text, true, figure.width));
        y += title_size + 8;
    }
    if (!figure.subtitle.empty()) {
        marks.push_back(heading(figure.subtitle, y + 10, axis_title_size, colour::grey, false, figure.width));
        y += axis_title_size + 8;
    }
    if (!marks.empty()) {
        y += 4;
    }
    if (figure.shared_legend) {
        const LegendSpec legend = sharedLegendSpec(figure.panels, figure.width - 2 * edge);
        marks.push_back({{"type", "group"},
                         {"name", "legend"},
                         {"encode", {{"update", {{"x", constant(edge)}, {"y", constant(y)}}}}},
                         {"marks", legend.marks}});
        y += legend.height + 6;
    }
    const std::size_t columns = static_cast<std::size_t>(std::max(1, figure.columns));
    const double panel_width = (figure.width - edge) / static_cast<double>(columns);
    double row_height = 0;
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
        if (i > 0 && i % columns == 0) {
            y += row_height + between_rows;
            row_height = 0;
        }
        PanelSpec panel =
            panelSpec(figure.panels[i], i, static_cast<double>(i % columns) * panel_width, y, panel_width);
        row_height = std::max(row_height, panel.height);
        data.insert(data.end(), panel.data.begin(), panel.data.end());
        marks.insert(marks.end(), panel.marks.begin(), panel.marks.end());
        panels.push_back(panel.meta);
    }
    return {{"$schema", "https://vega.github.io/schema/vega/v5.json"},
            {"description", figure.title},
            {"width", figure.width},
            {"height", std::ceil(y + row_height + edge / 2)},
            {"padding", 0},
            {"autosize", "none"},
            {"background", "white"},
            {"config", {{"axis", axisConfig()}}},
            {"usermeta", {{"panels", panels}, {"layers", layersMeta(figure)}}},
            {"data", data},
            {"marks", marks}};
}

}  // namespace slamot::report

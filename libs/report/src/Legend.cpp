#include "Legend.h"

#include <algorithm>
#include <set>

#include "LayerMarks.h"
#include "Text.h"

namespace slamot::report {
namespace {

using nlohmann::json;

constexpr double swatch = 22, after_swatch = 6, between_entries = 18, row_height = 18;  // pixels

json fixedMark(const char* type, json encoding) {
    return {{"type", type}, {"interactive", false}, {"encode", {{"update", std::move(encoding)}}}};
}

json ruleSwatch(double x, double y, const std::string& colour, double width, Dash dash, double opacity) {
    return fixedMark("rule", {{"x", constant(x)},
                              {"x2", constant(x + swatch)},
                              {"y", constant(y)},
                              {"stroke", constant(colour)},
                              {"strokeWidth", constant(width)},
                              {"strokeDash", constant(dashPattern(dash, width))},
                              {"strokeOpacity", constant(opacity)}});
}

json rectSwatch(double x, double y, const std::string& colour, double opacity) {
    constexpr double height = 11;
    return fixedMark("rect", {{"x", constant(x)},
                              {"y", constant(y - height / 2)},
                              {"width", constant(swatch)},
                              {"height", constant(height)},
                              {"fill", constant(colour)},
                              {"fillOpacity", constant(opacity)}});
}

/// A small example of a layer, left edge at x, middle at y.
struct Swatch {
    double x, y;

    json operator()(const Line& l) const { return ruleSwatch(x, y, l.colour, l.width, l.dash, l.opacity); }
    json operator()(const Rule& r) const { return ruleSwatch(x, y, r.colour, r.width, r.dash, 1); }
    json operator()(const Band& b) const { return rectSwatch(x, y, b.colour, b.opacity); }
    json operator()(const Bars& b) const { return rectSwatch(x, y, b.colour, b.opacity); }
    json operator()(const Points& p) const {
        json encoding = symbolEncoding(p);
        encoding["x"] = constant(x + swatch / 2);
        encoding["y"] = constant(y);
        return fixedMark("symbol", encoding);
    }
    json operator()(const Ellipses& e) const {
        return fixedMark("symbol", {{"x", constant(x + swatch / 2)},
                                    {"y", constant(y)},
                                    {"shape", constant("M-1,0A1,0.6,0,1,0,1,0A1,0.6,0,1,0,-1,0Z")},
                                    {"size", constant(15 * 15)},
                                    {"fill", constant("transparent")},
                                    {"stroke", constant(e.colour)},
                                    {"strokeOpacity", constant(e.opacity)},
                                    {"strokeWidth", constant(1)}});
    }
    json operator()(const HeatMap&) const { return nullptr; }  // has a colour bar instead
    json operator()(const Texts&) const { return nullptr; }
};

}  // namespace

std::string labelOf(const Layer& layer) {
    struct Label {
        std::string operator()(const HeatMap&) const { return {}; }
        std::string operator()(const Texts&) const { return {}; }
        std::string operator()(const Line& l) const { return l.label; }
        std::string operator()(const Points& l) const { return l.label; }
        std::string operator()(const Band& l) const { return l.label; }
        std::string operator()(const Ellipses& l) const { return l.label; }
        std::string operator()(const Bars& l) const { return l.label; }
        std::string operator()(const Rule& l) const { return l.label; }
    };
    return std::visit(Label{}, layer);
}

LegendSpec legendSpec(const Panel& panel, double width) {
    LegendSpec legend;
    if (panel.legend == LegendPlace::none) {
        return legend;
    }
    double x = 0, y = row_height / 2;
    for (const Layer& layer : panel.layers) {
        if (labelOf(layer).empty()) {
            continue;
        }
        const std::string label = fitText(labelOf(layer), label_size, width - swatch - after_swatch);
        const double entry_width = swatch + after_swatch + textWidth(label, label_size);
        const bool new_row = panel.legend == LegendPlace::right || x + entry_width > width;
        if (new_row && legend.height > 0) {
            x = 0;
            y += row_height;
        }
        legend.marks.push_back(std::visit(Swatch{x, y}, layer));
        legend.marks.push_back(fixedMark("text", {{"x", constant(x + swatch + after_swatch)},
                                                  {"y", constant(y)},
                                                  {"text", constant(label)},
                                                  {"baseline", constant("middle")},
                                                  {"font", constant(font)},
                                                  {"fontSize", constant(label_size)},
                                                  {"fill", constant(colour::text)}}));
        legend.width = std::max(legend.width, x + entry_width);
        legend.height = y + row_height / 2;
        x += entry_width + between_entries;
    }
    return legend;
}

LegendSpec sharedLegendSpec(const std::vector<Panel>& panels, double width) {
    Panel all;
    std::set<std::string> labels;
    for (const Panel& panel : panels) {
        for (const Layer& layer : panel.layers) {
            if (labels.insert(labelOf(layer)).second) {
                all.layers.push_back(layer);
            }
        }
    }
    return legendSpec(all, width);
}

}  // namespace slamot::report

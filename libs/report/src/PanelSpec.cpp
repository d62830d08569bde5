#include "PanelSpec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ColourMap.h"
#include "JsonText.h"
#include "LayerMarks.h"
#include "Legend.h"
#include "Text.h"

namespace slamot::report {
namespace {

using nlohmann::json;

// Room around the plotting area, pixels.
constexpr double left_margin = 66, right_margin = 18, bottom_margin = 44;
constexpr double title_height = 22, legend_gap = 6, note_height = 16;
constexpr double tick_label_room = 40;  // between the y axis and its title
constexpr double legend_column = 210, colour_bar_width = 12, colour_bar_room = 74;

json scale(const char* name, const AxisView& axis, json range) {
    return {{"name", name},
            {"type", axis.logarithmic ? "log" : "linear"},
            {"domain", {axis.low, axis.high}},
            {"range", std::move(range)},
            {"zero", false},
            {"nice", false}};
}

std::string axisTitle(const Axis& axis) {
    return axis.unit.empty() ? axis.label : fmt::format("{} [{}]", axis.label, axis.unit);
}

/// Labels that fit beside the axis: 12M rather than 12,000,000 and 2e-5 rather than 0.00002.
json tickFormat(const AxisView& view) {
    const double largest = std::max(std::abs(view.low), std::abs(view.high));
    return largest >= 1e5 ? json("~s") : largest < 2e-3 ? json("~e") : json();
}

/// `digits` times powers of ten within the view, every `step`-th power.
std::vector<double> logarithmicTicks(const AxisView& view, const std::vector<int>& digits, int step) {
    const int first = static_cast<int>(std::floor(std::log10(view.low)));
    const int last = static_cast<int>(std::ceil(std::log10(view.high)));
    std::vector<double> ticks;
    for (int exponent = first - (first % step); exponent <= last; exponent += step) {
        for (const int digit : digits) {
            const double tick = digit * std::pow(10, exponent);
            if (tick >= view.low && tick <= view.high) {
                ticks.push_back(tick);
            }
        }
    }
    return ticks;
}

/// Steps of 1, 2 or 5 times a power of ten, at least three of them in the view.
std::vector<double> evenTicks(const AxisView& view) {
    const double most = (view.high - view.low) / 4, power = std::pow(10, std::floor(std::log10(most)));
    const double step = power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
    std::vector<double> ticks;
    for (double i = std::ceil(view.low / step); i * step <= view.high; ++i) {
        ticks.push_back(i * step);
    }
    return ticks;
}

/// Powers of ten, at most `count` of them; where only few would be in view with more and more between them,
/// so that the axis can be read.
std::vector<double> logarithmicTicks(const AxisView& view, double count) {
    constexpr std::size_t readable = 3;
    const double decades = std::log10(view.high / view.low);
    const int step = std::max(1, static_cast<int>(std::ceil(decades / count)));
    std::vector<double> ticks =
        logarithmicTicks(view, decades <= 2 ? std::vector<int>{1, 2, 5} : std::vector<int>{1}, step);
    if (ticks.size() < readable) {
        ticks = logarithmicTicks(view, {1, 2, 3, 4, 5, 6, 7, 8, 9}, step);
    }
    return ticks.size() < readable ? evenTicks(view) : ticks;
}

json axisSpec(const Axis& axis, const AxisView& view, bool upright, bool map = false) {
    json result = {{"scale", upright ? "y" : "x"},     {"orient", upright ? "left" : "bottom"},
                   {"title", axisTitle(axis)},         {"grid", axis.categories.empty() || upright},
                   {"gridScale", upright ? "x" : "y"}, {"labelOverlap", "greedy"}};
    // Labels a fixed number of pixels apart; both axes of a map get the same step.
    const double count = view.pixels / (!upright ? 75 : map ? 55 : 38);
    json& label = result["encode"]["labels"]["update"]["text"]["signal"];
    if (upright) {
        result["minExtent"] = result["maxExtent"] = tick_label_room;
    }
    if (!axis.categories.empty()) {
        json places = json::array();
        for (std::size_t i = 0; i < axis.categories.size(); ++i) {
            places.push_back(i);
        }
        result["values"] = places;
        result["ticks"] = false;
        result["labelOverlap"] = false;
        label = jsonText(json(axis.categories)) + "[datum.value]";
    } else if (view.logarithmic) {
        result["values"] = logarithmicTicks(view, view.pixels / (upright ? 25 : 50));
        // One form for all labels of an axis.
        const bool plain = view.low >= 0.0009 && view.high < 100001;
        label = plain ? "format(datum.value, '~r')" : "format(datum.value, '~e')";
    } else {
        result["tickCount"] = count;
        result.erase("encode");
        if (const json format = tickFormat(view); !format.is_null()) {
            result["format"] = format;
        }
    }
    return result;
}

json textMark(const std::string& text, double x, double y, double size, const char* fill, bool bold = false) {
    return {{"type", "text"},
            {"interactive", false},
            {"encode",
             {{"update",
               {{"text", constant(text)},
                {"x", constant(x)},
                {"y", constant(y)},
                {"font", constant(font)},
                {"fontSize", constant(size)},
                {"fontWeight", constant(bold ? "bold" : "normal")},
                {"fill", constant(fill)}}}}}};
}

json groupMark(const std::string& name, double x, double y, double width, double height) {
    return {{"type", "group"},
            {"name", name},
            {"encode",
             {{"update",
               {{"x", constant(x)},
                {"y", constant(y)},
                {"width", constant(width)},
                {"height", constant(height)}}}}}};
}

const HeatMap* heatMapOf(const Panel& panel) {
    for (const Layer& layer : panel.layers) {
        if (const HeatMap* map = std::get_if<HeatMap>(&layer)) {
            return map;
        }
    }
    return nullptr;
}

json colourBar(const HeatMap& map, const std::string& name, double x, double y, double height) {
    json bar = groupMark(name, x, y, colour_bar_width, height);
    bar["encode"]["update"]["fill"] = constant(colourGradient(map.colours));
    bar["encode"]["update"]["stroke"] = constant(colour::frame);
    const AxisView view{map.low, map.high, false, height};
    bar["scales"] = json::array({scale("y", view, {height, 0})});
    Axis axis;
    axis.label = map.label;
    json spec = axisSpec(axis, view, true);
    spec["orient"] = "right";
    spec["grid"] = false;
    spec.erase("gridScale");  // the bar has one scale only
    spec["minExtent"] = spec["maxExtent"] = tick_label_room - 4;
    bar["axes"] = json::array({spec});
    return bar;
}

/// Moving is for plain numbers: ticks of logarithmic axes are chosen here, and images have a fixed size.
json axisMeta(const Axis& axis, const AxisView& view, bool has_heat_map) {
    return {{"domain", {view.low, view.high}},
            {"log", view.logarithmic},
            {"categories", !axis.categories.empty()},
            {"title", axisTitle(axis)},
            {"moves", !view.logarithmic && axis.categories.empty() && !has_heat_map}};
}

}  // namespace

PanelSpec panelSpec(const Panel& panel, std::size_t index, double left, double top, double width) {
    const HeatMap* heat_map = heatMapOf(panel);
    const bool beside = panel.legend == LegendPlace::right;
    const double bar_room = heat_map ? colour_bar_room : 0;
    const double inner = width - left_margin - right_margin - bar_room;
    const LegendSpec legend = legendSpec(panel, beside ? legend_column : inner);
    const double plot_width = inner - (beside && legend.width > 0 ? legend.width + right_margin : 0);
    const double title_room = panel.title.empty() ? 0 : title_height;
    const double legend_room = beside || legend.height == 0 ? 0 : legend.height + legend_gap;
    const double plot_left = left + left_margin, plot_top = top + title_room + legend_room;
    const PanelView view = panelView(panel, plot_width);

    PanelSpec spec;
    spec.data = json::array();
    spec.marks = json::array();
    json plot = groupMark(fmt::format("panel_{}", index), plot_left, plot_top, plot_width, panel.height);
    plot["encode"]["update"]["stroke"] = constant(colour::frame);
    plot["scales"] =
        json::array({scale("x", view.x, {0, plot_width}), scale("y", view.y, {panel.height, 0})});
    plot["axes"] =
        json::array({axisSpec(panel.x, view.x, false), axisSpec(panel.y, view.y, true, panel.equal_aspect)});
    plot["marks"] = json::array();
    for (std::size_t i = 0; i < panel.layers.size(); ++i) {
        const std::string name = fmt::format("p{}_l{}", index, i);
        LayerSpec layer = layerSpec(panel.layers[i], name, view);
        if (!layer.data.is_null()) {
            spec.data.push_back({{"name", name}, {"values", std::move(layer.data)}});
        }
        for (json& mark : layer.marks) {
            mark["name"] = "mark_" + name;
            plot["marks"].push_back(std::move(mark));
        }
    }
    spec.marks.push_back(std::move(plot));

    if (!panel.title.empty()) {
        spec.marks.push_back(textMark(fitText(panel.title, panel_title_size, width - left_margin), plot_left,
                                      top + 12, panel_title_size, colour::text, true));
    }
    if (legend.height > 0) {
        json group = groupMark(fmt::format("legend_{}", index),
                               beside ? plot_left + plot_width + bar_room + right_margin : plot_left,
                               beside ? plot_top : top + title_room, legend.width, legend.height);
        group["marks"] = legend.marks;
        spec.marks.push_back(std::move(group));
    }
    if (heat_map) {
        spec.marks.push_back(colourBar(*heat_map, fmt::format("colours_{}", index),
                                       plot_left + plot_width + right_margin, plot_top, panel.height));
    }
    spec.meta = {{"left", plot_left},
                 {"top", plot_top},
                 {"width", plot_width},
                 {"height", panel.height},
                 {"equal", panel.equal_aspect},
                 {"x", axisMeta(panel.x, view.x, heat_map != nullptr)},
                 {"y", axisMeta(panel.y, view.y, heat_map != nullptr)}};
    spec.height = title_room + legend_room + panel.height + bottom_margin;
    if (!panel.note.empty()) {
        spec.marks.push_back(textMark(fitText(panel.note, label_size, width - left_margin), plot_left,
                                      top + spec.height + 8, label_size, colour::grey));
        spec.height += note_height;
    }
    return spec;
}

}  // namespace slamot::report

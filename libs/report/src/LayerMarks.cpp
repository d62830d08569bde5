#include "LayerMarks.h"

#include <algorithm>
#include <cmath>

#include "ColourMap.h"
#include "PixelPath.h"
#include "Text.h"
#include "slamot/report/Decimation.h"
#include "slamot/core/data/Ellipse.h"

namespace slamot::report {
namespace {

using nlohmann::json;

json field(const char* scale, const char* name) {
    return {{"scale", scale}, {"field", name}};
}

json mark(const char* type, const json& data_name, json encoding) {
    json result = {{"type", type},
                   {"clip", true},
                   {"interactive", false},
                   {"encode", {{"update", std::move(encoding)}}}};
    if (!data_name.is_null()) {
        result["from"] = {{"data", data_name}};
    }
    return result;
}

json row(const Eigen::Vector2d& p) {
    return {{"x", p.x()}, {"y", p.y()}};
}

/// Rows of all pieces with a row of nulls between two, where the line is not defined.
json pieceRows(const std::vector<Points2>& pieces) {
    json rows = json::array();
    for (const Points2& piece : pieces) {
        if (!rows.empty()) {
            rows.push_back({{"x", nullptr}, {"y", nullptr}});
        }
        for (const Eigen::Vector2d& p : piece) {
            rows.push_back(row(p));
        }
    }
    return rows;
}

json lineMark(const std::string& name, const std::string& colour, double width, double opacity) {
    return mark("line", name,
                {{"x", field("x", "x")},
                 {"y", field("y", "y")},
                 {"defined", {{"signal", "isValid(datum.x) && isValid(datum.y)"}}},
                 {"stroke", constant(colour)},
                 {"strokeWidth", constant(width)},
                 {"strokeOpacity", constant(opacity)},
                 {"strokeJoin", constant("round")}});
}

LayerSpec specOf(const Line& line, const std::string& name, const PanelView& view) {
    json m = lineMark(name, line.colour, line.width, line.opacity);
    if (line.dash == Dash::solid) {
        m["encode"]["update"]["strokeCap"] = constant("round");  // shows single points between gaps
    } else {
        m["encode"]["update"]["strokeDash"] = constant(dashPattern(line.dash, line.width));
    }
    return {pieceRows(visiblePieces(line.points, view)), json::array({m})};
}

LayerSpec specOf(const Points& points, const std::string& name, const PanelView& view) {
    Points2 shown, pixels;
    for (const Eigen::Vector2d& p : points.points) {
        if (view.shows(p) && nearPanel(p, view, points.size)) {
            shown.push_back(p);
            pixels.push_back(view.toPixel(p));
        }
    }
    constexpr std::size_t many = 2000;  // marks; fewer are cheap, so all are kept
    json rows = json::array();
    if (shown.size() <= many) {
        for (const Eigen::Vector2d& p : shown) {
            rows.push_back(row(p));
        }
    } else {
        for (const std::size_t i : keepOnePerPixel(pixels)) {
            rows.push_back(row(shown[i]));
        }
    }
    json encoding = symbolEncoding(points);
    encoding["x"] = field("x", "x");
    encoding["y"] = field("y", "y");
    return {rows, json::array({mark("symbol", name, encoding)})};
}

LayerSpec specOf(const Band& band, const std::string& name, const PanelView& view) {
    const auto finite = [&](const BandRow& r) {
        return view.x.shows(r.x) && view.y.shows(r.low) && view.y.shows(r.high);
    };
    json rows = json::array();
    for (std::size_t first = 0; first < band.rows.size();) {
        std::size_t end = first;
        Points2 lows, highs;
        for (; end < band.rows.size() && finite(band.rows[end]); ++end) {
            lows.push_back(view.toPixel({band.rows[end].x, band.rows[end].low}));
            highs.push_back(view.toPixel({band.rows[end].x, band.rows[end].high}));
        }
        std::vector<std::size_t> kept;
        const std::vector<std::size_t> low = keepColumnExtremes(lows), high = keepColumnExtremes(highs);
        std::set_union(low.begin(), low.end(), high.begin(), high.end(), std::back_inserter(kept));
        if (!kept.empty() && !rows.empty()) {
            rows.push_back({{"x", nullptr}, {"low", nullptr}, {"high", nullptr}});
        }
        for (const std::size_t i : kept) {
            const BandRow& r = band.rows[first + i];
            rows.push_back({{"x", r.x}, {"low", r.low}, {"high", r.high}});
        }
        first = std::max(end, first + 1);
    }
    return {rows, json::array({mark("area", name,
                                    {{"x", field("x", "x")},
                                     {"y", field("y", "high")},
                                     {"y2", field("y", "low")},
                                     {"defined", {{"signal", "isValid(datum.x)"}}},
                                     {"fill", constant(band.colour)},
                                     {"fillOpacity", constant(band.opacity)}})})};
}

LayerSpec specOf(const Ellipses& ellipses, const std::string& name, const PanelView& view) {
    // Of very many, those that vanish beneath the mark of their middle are left out.
    constexpr std::size_t many = 2000;
    const double least_radius = ellipses.gaussians.size() > many ? 1.5 : 0;  // pixels
    std::vector<Points2> outlines;
    for (const GaussianPoint& g : ellipses.gaussians) {
        if (!view.shows(g.mean) || !g.covariance.allFinite()) {
            continue;
        }
        const double sigma = std::sqrt(std::max(0.0, g.covariance.trace()));
        const Eigen::Vector2d beside = g.mean + Eigen::Vector2d(ellipses.k * sigma, 0);
        const double radius = std::abs(view.toPixel(beside).x() - view.toPixel(g.mean).x());
        if (radius >= least_radius && nearPanel(g.mean, view, radius)) {
            // A chord of n strays from its arc by r (pi/n)^2 / 2; this keeps it below a sixth of a pixel.
            const int count = std::clamp(static_cast<int>(std::ceil(5.5 * std::sqrt(radius))), 12, 120);
            outlines.push_back(ellipseOutline(g.mean, g.covariance, ellipses.k, count));
        }
    }
    return {pieceRows(outlines),
            json::array({lineMark(name, ellipses.colour, ellipses.width, ellipses.opacity)})};
}

LayerSpec specOf(const Bars& bars, const std::string& name, const PanelView& view) {
    const double base = view.y.shows(bars.base) ? bars.base : view.y.low;
    json rows = json::array();
    for (const Bar& bar : bars.bars) {
        if (view.x.shows(bar.from) && view.x.shows(bar.to) && view.y.shows(bar.value)) {
            rows.push_back({{"from", bar.from}, {"to", bar.to}, {"value", bar.value}});
        }
    }
    return {rows, json::array({mark("rect", name,
                                    {{"x", field("x", "from")},
                                     {"x2", field("x", "to")},
                                     {"y", field("y", "value")},
                                     {"y2", {{"scale", "y"}, {"value", base}}},
                                     {"fill", constant(bars.colour)},
                                     {"fillOpacity", constant(bars.opacity)},
                                     {"stroke", constant("white")},
                                     {"strokeWidth", constant(0.5)}})})};
}

LayerSpec specOf(const Rule& rule, const std::string&, const PanelView& view) {
    const AxisView& axis = rule.upright ? view.x : view.y;
    if (!axis.shows(rule.value) || rule.value < axis.low || rule.value > axis.high) {
        return {nullptr, json::array()};
    }
    const json across = {{"scale", rule.upright ? "x" : "y"}, {"value", rule.value}};
    json encoding = {{"stroke", constant(rule.colour)},
                     {"strokeWidth", constant(rule.width)},
                     {"strokeDash", constant(dashPattern(rule.dash, rule.width))}};
    const double length = rule.upright ? view.y.pixels : view.x.pixels;
    encoding[rule.upright ? "x" : "y"] = across;
    encoding[rule.upright ? "y" : "x"] = constant(0);
    encoding[rule.upright ? "y2" : "x2"] = constant(length);
    return {nullptr, json::array({mark("rule", nullptr, encoding)})};
}

LayerSpec specOf(const Texts& texts, const std::string& name, const PanelView& view) {
    json rows = json::array();
    for (const TextAt& t : texts.texts) {
        if (view.shows(t.position) && nearPanel(t.position, view, 0)) {
            json r = row(t.position);
            r["text"] = t.text;
            rows.push_back(r);
        }
    }
    return {rows, json::array({mark("text", name,
                                    {{"x", field("x", "x")},
                                     {"y", field("y", "y")},
                                     {"text", {{"field", "text"}}},
                                     {"dx", constant(texts.offset.x())},
                                     {"dy", constant(-texts.offset.y())},
                                     {"font", constant(font)},
                                     {"fontSize", constant(label_size)},
                                     {"fill", constant(texts.colour)}})})};
}

LayerSpec specOf(const HeatMap& map, const std::string&, const PanelView& view) {
    const Eigen::Vector2d corner = view.toPixel({map.x_min, map.y_max});
    const Eigen::Vector2d size = view.toPixel({map.x_max, map.y_min}) - corner;
    const json image = mark("image", nullptr,
                            {{"url", constant(heatMapImage(map))},
                             {"x", {{"scale", "x"}, {"value", map.x_min}}},
                             {"y", {{"scale", "y"}, {"value", map.y_max}}},
                             {"width", constant(size.x())},
                             {"height", constant(-size.y())},
                             {"aspect", constant(false)},
                             {"smooth", constant(false)}});
    return {nullptr, json::array({image})};
}

}  // namespace

json constant(json value) {
    return {{"value", std::move(value)}};
}

json dashPattern(Dash dash, double width) {
    switch (dash) {
        case Dash::dashed:
            return json::array({4 * width, 3 * width});
        case Dash::dotted:
            return json::array({1.2 * width, 2 * width});
        case Dash::solid:
            break;
    }
    return json::array();
}

json symbolEncoding(const Points& points) {
    json encoding = {{"size", constant(points.size * points.size)}, {"opacity", constant(points.opacity)}};
    const bool strokes =
        points.symbol == Symbol::times || points.symbol == Symbol::plus || points.symbol == Symbol::ring;
    if (strokes) {
        encoding["stroke"] = constant(points.colour);
        encoding["strokeWidth"] = constant(points.size < 6 ? 0.9 : 1.2);
        encoding["fill"] = constant("transparent");
    } else {
        encoding["fill"] = constant(points.colour);
    }
    if (points.outlined) {
        encoding["stroke"] = constant("white");
        encoding["strokeWidth"] = constant(1.2);
    }
    switch (points.symbol) {
        case Symbol::times:
            encoding["shape"] = constant("M-1,-1L1,1M-1,1L1,-1");
            break;
        case Symbol::plus:
            encoding["shape"] = constant("M-1,0L1,0M0,-1L0,1");
            break;
        case Symbol::square:
            encoding["shape"] = constant("square");
            break;
        case Symbol::triangle:
            encoding["shape"] = constant("triangle-up");
            break;
        case Symbol::dot:
        case Symbol::ring:
            encoding["shape"] = constant("circle");
            break;
    }
    return encoding;
}

LayerSpec layerSpec(const Layer& layer, const std::string& data_name, const PanelView& view) {
    return std::visit([&](const auto& l) { return specOf(l, data_name, view); }, layer);
}

}  // namespace slamot::report

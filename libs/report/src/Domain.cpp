#include "Domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace slamot::report {
namespace {

/// The smallest interval that holds all values an axis can show.
struct Extent {
    bool logarithmic = false;
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

    bool empty() const { return low > high; }
    void include(double value) {
        if (std::isfinite(value) && (!logarithmic || value > 0)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    }
};

struct Extents {
    Extent x, y;
    /// Where upright bars stand; no padding below (or above) it.
    std::optional<double> bar_base;

    void include(const Eigen::Vector2d& p) {
        if (p.allFinite()) {
            x.include(p.x());
            y.include(p.y());
        }
    }
    void operator()(const HeatMap& map) {
        include({map.x_min, map.y_min});
        include({map.x_max, map.y_max});
    }
    void operator()(const Band& band) {
        for (const BandRow& row : band.rows) {
            include({row.x, row.low});
            include({row.x, row.high});
        }
    }
    void operator()(const Bars& bars) {
        for (const Bar& bar : bars.bars) {
            include({bar.from, bar.value});
            include({bar.to, bar.value});
        }
        y.include(bars.base);
        bar_base = bars.base;
    }
    void operator()(const Ellipses& ellipses) {
        for (const GaussianPoint& g : ellipses.gaussians) {
            const Eigen::Vector2d reach = ellipses.k * g.covariance.diagonal().cwiseMax(0).cwiseSqrt();
            include(g.mean - reach);
            include(g.mean + reach);
        }
    }
    void operator()(const Line& line) { includeAll(line.points); }
    void operator()(const Points& points) { includeAll(points.points); }
    void operator()(const Rule& rule) { (rule.upright ? x : y).include(rule.value); }
    void operator()(const Texts& texts) {
        for (const TextAt& text : texts.texts) {
            include(text.position);
        }
    }

  private:
    void includeAll(const Points2& points) {
        for (const Eigen::Vector2d& p : points) {
            include(p);
        }
    }
};

AxisView axisView(const Axis& axis, Extent extent, double pixels, std::optional<double> unpadded = {}) {
    if (!axis.categories.empty()) {
        return {-0.5, static_cast<double>(axis.categories.size()) - 0.5, false, pixels};
    }
    if (axis.min && axis.max && !(*axis.min < *axis.max)) {
        throw std::invalid_argument(
            fmt::format("the axis '{}' goes from {} to {}; expected a rising interval", axis.label, *axis.min,
                        *axis.max));
    }
    if (extent.empty()) {
        extent.low = axis.logarithmic ? 1 : 0;
        extent.high = axis.logarithmic ? 10 : 1;
    }
    const auto warp = [&](double v) { return axis.logarithmic ? std::log10(v) : v; };
    const auto unwarp = [&](double v) { return axis.logarithmic ? std::pow(10, v) : v; };
    double low = warp(axis.min.value_or(extent.low)), high = warp(axis.max.value_or(extent.high));
    if (low > high) {  // the end that was given lies beyond the data
        (axis.max ? low : high) = axis.max ? high : low;
    }
    // A single value gets room around it: a third of a decade, or a tenth of itself.
    const double size = std::max(std::abs(low), std::abs(high));
    const double least = axis.logarithmic ? 0.3 : size > 0 ? 0.1 * size : 1;
    const bool flat = high - low <= 1e-9 * size;
    const double pad = flat ? least : axis.padding * (high - low);
    const auto stands = [&](double end) { return !flat && unpadded == end; };
    low -= axis.min || stands(extent.low) ? 0 : pad;
    high += axis.max || stands(extent.high) ? 0 : pad;
    return {axis.min.value_or(unwarp(low)), axis.max.value_or(unwarp(high)), axis.logarithmic, pixels};
}

/// Widens the axis that has more pixels per metre, about its middle.
void equaliseAspect(PanelView& view) {
    const double metres_per_pixel =
        std::max((view.x.high - view.x.low) / view.x.pixels, (view.y.high - view.y.low) / view.y.pixels);
    for (AxisView* axis : {&view.x, &view.y}) {
        const double middle = (axis->low + axis->high) / 2, half = metres_per_pixel * axis->pixels / 2;
        axis->low = middle - half;
        axis->high = middle + half;
    }
}

}  // namespace

bool AxisView::shows(double value) const {
    return std::isfinite(value) && (!logarithmic || value > 0);
}

double AxisView::toPixel(double value) const {
    return logarithmic ? pixels * std::log(value / low) / std::log(high / low)
                       : pixels * (value - low) / (high - low);
}

double AxisView::fromPixel(double pixel) const {
    return logarithmic ? low * std::pow(high / low, pixel / pixels) : low + (high - low) * pixel / pixels;
}

PanelView panelView(const Panel& panel, double width) {
    Extents extents;
    extents.x.logarithmic = panel.x.logarithmic;
    extents.y.logarithmic = panel.y.logarithmic;
    for (const Layer& layer : panel.layers) {
        std::visit([&](const auto& l) { extents(l); }, layer);
    }
    PanelView view{axisView(panel.x, extents.x, width),
                   axisView(panel.y, extents.y, panel.height, extents.bar_base)};
    if (panel.equal_aspect) {
        equaliseAspect(view);
    }
    return view;
}

}  // namespace slamot::report

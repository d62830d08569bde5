#pragma once
// What part of the world a panel shows and where that lies in pixels.
#include "slamot/report/Figure.h"

namespace slamot::report {

/// One axis: [low, high] on `pixels` pixels; y axes count pixels upwards here.
struct AxisView {
    double low = 0, high = 1;
    bool logarithmic = false;
    double pixels = 1;

    /// Whether a value has a place on the axis, in view or not.
    bool shows(double value) const;
    double toPixel(double value) const;
    double fromPixel(double pixel) const;
};

struct PanelView {
    AxisView x, y;

    bool shows(const Eigen::Vector2d& point) const { return x.shows(point.x()) && y.shows(point.y()); }
    Eigen::Vector2d toPixel(const Eigen::Vector2d& p) const { return {x.toPixel(p.x()), y.toPixel(p.y())}; }
    Eigen::Vector2d fromPixel(const Eigen::Vector2d& p) const {
        return {x.fromPixel(p.x()), y.fromPixel(p.y())};
    }
};

PanelView panelView(const Panel& panel, double width);

}  // namespace slamot::report

#include "slamot/report/Figure.h"

#include <fmt/format.h>

#include <stdexcept>

namespace slamot::report {

Axis timeAxis(const std::string& label) {
    Axis axis;
    axis.label = label;
    axis.unit = "s";
    axis.padding = 0;
    return axis;
}

Points2 series(const std::vector<double>& x, const std::vector<double>& y) {
    if (x.size() != y.size()) {
        throw std::invalid_argument(
            fmt::format("a series has {} values of x but {} of y; expected as many", x.size(), y.size()));
    }
    Points2 points;
    points.reserve(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        points.emplace_back(x[i], y[i]);
    }
    return points;
}

Points2 histogramOutline(const std::vector<double>& edges, const std::vector<double>& counts) {
    if (edges.size() != counts.size() + 1) {
        throw std::invalid_argument(fmt::format(
            "a histogram has {} edges and {} counts; expected one edge more", edges.size(), counts.size()));
    }
    Points2 points;
    points.emplace_back(edges.front(), 0);
    for (std::size_t i = 0; i < counts.size(); ++i) {
        points.emplace_back(edges[i], counts[i]);
        points.emplace_back(edges[i + 1], counts[i]);
    }
    points.emplace_back(edges.back(), 0);
    return points;
}

std::vector<BandRow> sigmaBand(const std::vector<double>& x, const std::vector<double>& sigma, double k) {
    std::vector<BandRow> rows;
    rows.reserve(x.size());
    for (const Eigen::Vector2d& p : series(x, sigma)) {
        rows.push_back({p.x(), -k * p.y(), k * p.y()});
    }
    return rows;
}

Bar groupedBar(std::size_t category, std::size_t series, std::size_t series_count, double value) {
    constexpr double group_width = 0.8;  // of the distance between categories; the rest separates the groups
    const double width = group_width / static_cast<double>(series_count);
    const double from = static_cast<double>(category) - group_width / 2 + static_cast<double>(series) * width;
    return {from, from + width, value};
}

}  // namespace slamot::report

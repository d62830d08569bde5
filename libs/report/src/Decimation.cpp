#include "slamot/report/Decimation.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/register/point.hpp>
#include <cmath>
#include <set>

namespace slamot::report {
namespace {

/// A point that remembers its place, through Boost.Geometry and back.
struct PathPoint {
    double x = 0, y = 0;
    std::size_t index = 0;
};

}  // namespace
}  // namespace slamot::report

BOOST_GEOMETRY_REGISTER_POINT_2D(slamot::report::PathPoint, double, boost::geometry::cs::cartesian, x, y)

namespace slamot::report {

std::vector<std::size_t> keepColumnExtremes(const Points2& pixels) {
    std::vector<std::size_t> kept;
    const auto column = [&](std::size_t i) { return std::floor(pixels[i].x()); };
    for (std::size_t first = 0; first < pixels.size();) {
        std::size_t end = first, lowest = first, highest = first;
        for (; end < pixels.size() && column(end) == column(first); ++end) {
            lowest = pixels[end].y() < pixels[lowest].y() ? end : lowest;
            highest = pixels[end].y() > pixels[highest].y() ? end : highest;
        }
        for (const std::size_t i : std::set<std::size_t>{first, lowest, highest, end - 1}) {
            kept.push_back(i);
        }
        first = end;
    }
    return kept;
}

std::vector<std::size_t> simplifyPath(const Points2& pixels, double tolerance) {
    boost::geometry::model::linestring<PathPoint> path, simple;
    path.reserve(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        path.push_back({pixels[i].x(), pixels[i].y(), i});
    }
    boost::geometry::simplify(path, simple, tolerance);
    std::vector<std::size_t> kept;
    for (const PathPoint& p : simple) {
        kept.push_back(p.index);
    }
    return kept;
}

std::vector<std::size_t> keepOnePerPixel(const Points2& pixels) {
    std::set<std::pair<double, double>> occupied;
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (occupied.emplace(std::floor(pixels[i].x()), std::floor(pixels[i].y())).second) {
            kept.push_back(i);
        }
    }
    return kept;
}

}  // namespace slamot::report

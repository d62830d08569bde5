#include "PixelPath.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/linestring.hpp>
#include <boost/geometry/geometries/multi_linestring.hpp>
#include <boost/geometry/geometries/point_xy.hpp>

#include "slamot/report/Decimation.h"

namespace slamot::report {
namespace {

/// How far beyond the panel lines are drawn (and clipped there by Vega): a page may let its reader pan.
constexpr double margin = 2000;  // pixels

bool withinMargin(const Eigen::Vector2d& pixel, const PanelView& view) {
    return pixel.x() >= -margin && pixel.x() <= view.x.pixels + margin && pixel.y() >= -margin &&
           pixel.y() <= view.y.pixels + margin;
}

/// Runs of points that the panel's axes can show.
std::vector<Points2> splitAtGaps(const Points2& points, const PanelView& view) {
    std::vector<Points2> runs;
    bool gap = true;
    for (const Eigen::Vector2d& p : points) {
        if (!view.shows(p)) {
            gap = true;
            continue;
        }
        if (gap) {
            runs.emplace_back();
        }
        gap = false;
        runs.back().push_back(p);
    }
    return runs;
}

Points2 decimate(const Points2& run, const Points2& pixels, const PanelView& view) {
    // Four points a column draw any line; shorter runs are left as they are.
    if (static_cast<double>(run.size()) <= 4 * view.x.pixels && run.size() <= 1000) {
        return run;
    }
    constexpr double tolerance = 0.2;  // pixels
    const bool rising = std::is_sorted(pixels.begin(), pixels.end(),
                                       [](const auto& a, const auto& b) { return a.x() < b.x(); });
    Points2 kept;
    for (const std::size_t i : rising ? keepColumnExtremes(pixels) : simplifyPath(pixels, tolerance)) {
        kept.push_back(run[i]);
    }
    return kept;
}

std::vector<Points2> cutToMargin(const Points2& pixels, const PanelView& view) {
    namespace bg = boost::geometry;
    using Point = bg::model::d2::point_xy<double>;
    using Path = bg::model::linestring<Point>;
    const bg::model::box<Point> box{{-margin, -margin}, {view.x.pixels + margin, view.y.pixels + margin}};
    Path path;
    for (const Eigen::Vector2d& p : pixels) {
        path.push_back({p.x(), p.y()});
    }
    bg::model::multi_linestring<Path> cut;
    bg::intersection(box, path, cut);
    std::vector<Points2> pieces;
    for (const Path& piece : cut) {
        Points2& points = pieces.emplace_back();
        for (const Point& p : piece) {
            points.push_back(view.fromPixel({p.x(), p.y()}));
        }
    }
    return pieces;
}

}  // namespace

std::vector<Points2> visiblePieces(const Points2& points, const PanelView& view) {
    const auto toPixels = [&](const Points2& run) {
        Points2 pixels;
        for (const Eigen::Vector2d& p : run) {
            pixels.push_back(view.toPixel(p));
        }
        return pixels;
    };
    std::vector<Points2> pieces;
    for (const Points2& run : splitAtGaps(points, view)) {
        const Points2 pixels = toPixels(run);
        const bool inside = std::all_of(pixels.begin(), pixels.end(),
                                        [&](const Eigen::Vector2d& p) { return withinMargin(p, view); });
        if (inside) {
            pieces.push_back(decimate(run, pixels, view));
            continue;
        }
        for (const Points2& piece : cutToMargin(pixels, view)) {
            pieces.push_back(decimate(piece, toPixels(piece), view));
        }
    }
    return pieces;
}

bool nearPanel(const Eigen::Vector2d& point, const PanelView& view, double reach) {
    const Eigen::Vector2d p = view.toPixel(point);
    return p.x() >= -reach && p.x() <= view.x.pixels + reach && p.y() >= -reach &&
           p.y() <= view.y.pixels + reach;
}

}  // namespace slamot::report

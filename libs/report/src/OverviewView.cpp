#include "OverviewView.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace slamot::report {
namespace {

using Box = Eigen::AlignedBox2d;

Box boxOf(const Points2& points, std::size_t count) {
    Box box;
    for (std::size_t i = 0; i < count; ++i) {
        box.extend(points[i]);
    }
    return box;
}

Points2 finiteOnes(const Points2& points) {
    Points2 finite;
    std::copy_if(points.begin(), points.end(), std::back_inserter(finite),
                 [](const Eigen::Vector2d& p) { return p.allFinite(); });
    return finite;
}

Eigen::Vector2d medianOf(Points2 points) {
    Eigen::Vector2d median;
    for (int axis = 0; axis < 2; ++axis) {
        const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
        std::nth_element(points.begin(), middle, points.end(),
                         [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
        median[axis] = (*middle)[axis];
    }
    return median;
}

Points2 positionsOf(const std::vector<MapObject>& objects) {
    Points2 positions;
    for (const MapObject& object : objects) {
        positions.push_back(object.position);
    }
    return positions;
}

Box withEllipses(const Box& box, const std::vector<MapObject>& objects) {
    Box wider = box;
    for (const MapObject& object : objects) {
        if (object.reach.allFinite() && box.contains(object.position)) {
            wider.extend(object.position - object.reach).extend(object.position + object.reach);
        }
    }
    const Eigen::Vector2d most = Eigen::Vector2d::Constant(0.1 * box.sizes().maxCoeff());
    return {wider.min().cwiseMax(box.min() - most), wider.max().cwiseMin(box.max() + most)};
}

}  // namespace

MapObject mapObject(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance) {
    return {mean, 3 * covariance.diagonal().cwiseMax(0).cwiseSqrt()};
}

MapView mapView(const Points2& ways, const std::vector<MapObject>& objects) {
    const Points2 paths = finiteOnes(ways);
    Points2 things = finiteOnes(positionsOf(objects));
    const Box core = boxOf(paths, paths.size());
    MapView view;
    if (paths.empty() && things.empty()) {
        return view;
    }
    Box box = core;
    if (!things.empty()) {
        const Eigen::Vector2d middle = medianOf(things);
        const auto distance = [&](const Eigen::Vector2d& p) {
            return core.isEmpty() ? (p - middle).norm() : core.exteriorDistance(p);
        };
        std::sort(things.begin(), things.end(),
                  [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
        const std::size_t few = things.size() < 10 ? 0 : (things.size() + 49) / 50;  // 2 %, rounded up
        const Box most = boxOf(things, things.size() - few).merged(core);
        box = most;
        for (std::size_t i = things.size() - few; i < things.size(); ++i) {
            const Box with = box.merged(Box(things[i]));
            box = (with.sizes().array() <= 2 * most.sizes().array()).all() ? with : box;
        }
    }
    box = withEllipses(box, objects);
    // A standing robot without a map still gets a metre around it.
    const double least = std::max(1.0, 0.05 * box.sizes().maxCoeff()) / 2;
    view.low = box.min().cwiseMin((box.center().array() - least).matrix());
    view.high = box.max().cwiseMax((box.center().array() + least).matrix());
    view.outside =
        static_cast<std::size_t>(std::count_if(things.begin(), things.end(), [&](const Eigen::Vector2d& p) {
            return !Box(view.low, view.high).contains(p);
        }));
    return view;
}

}  // namespace slamot::report

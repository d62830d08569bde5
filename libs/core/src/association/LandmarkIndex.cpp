#include "slamot/core/association/LandmarkIndex.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

#include "slamot/core/association/ChiSquare.h"

namespace slamot {
namespace {

namespace geometry = boost::geometry;
using Point = geometry::model::d2::point_xy<double>;
using Box = geometry::model::box<Point>;
using Value = std::pair<Point, BlockId>;

Value valueOf(const Vector2& position, BlockId landmark) {
    return {Point(position.x(), position.y()), landmark};
}

}  // namespace

class LandmarkIndex::Tree : public geometry::index::rtree<Value, geometry::index::quadratic<16>> {};

LandmarkIndex::LandmarkIndex(double slack) : slack_(slack), tree_(std::make_unique<Tree>()) {}
LandmarkIndex::~LandmarkIndex() = default;
LandmarkIndex::LandmarkIndex(LandmarkIndex&&) noexcept = default;
LandmarkIndex& LandmarkIndex::operator=(LandmarkIndex&&) noexcept = default;

void LandmarkIndex::set(BlockId landmark, const Vector2& position) {
    if (!position.allFinite())
        throw std::invalid_argument("LandmarkIndex: the position of landmark " + std::to_string(landmark) +
                                    " is not finite");
    const auto [entry, is_new] = places_.try_emplace(landmark, Place{position, position});
    Place& place = entry->second;
    place.told = position;
    if (!is_new) {
        if ((position - place.in_tree).norm() <= slack_) return;
        tree_->remove(valueOf(place.in_tree, landmark));
        place.in_tree = position;
    }
    tree_->insert(valueOf(position, landmark));
}

void LandmarkIndex::remove(BlockId landmark) {
    tree_->remove(valueOf(places_.at(landmark).in_tree, landmark));
    places_.erase(landmark);
}

template <class Keep>
std::vector<BlockId> LandmarkIndex::search(const Vector2& centre, double radius, const Keep& keep) const {
    const double reach = radius + slack_;
    const Box box(Point(centre.x() - reach, centre.y() - reach),
                  Point(centre.x() + reach, centre.y() + reach));
    std::vector<BlockId> out;
    for (auto found = tree_->qbegin(geometry::index::intersects(box)); found != tree_->qend(); ++found) {
        const Vector2 to = places_.at(found->second).told - centre;
        if (to.norm() <= radius && keep(to)) out.push_back(found->second);
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<BlockId> LandmarkIndex::within(const Vector2& centre, double radius) const {
    return search(centre, radius, [](const Vector2&) { return true; });
}

std::vector<BlockId> LandmarkIndex::inView(const PoseGaussian& robot, const RangeBearingSensor& sensor,
                                           double probability, double margin) const {
    if (!(sensor.max_range > 0))
        throw std::invalid_argument("LandmarkIndex: sensor '" + sensor.label +
                                    "' has no max_range, expected one above 0 m");
    const Pose2 at = robot.mean * sensor.pose;
    const Matrix2 P = robot.covariance.topLeftCorner<2, 2>();
    const double longest = Eigen::SelfAdjointEigenSolver<Matrix2>(P, Eigen::EigenvaluesOnly).eigenvalues()(1);
    const double turned = std::sqrt(chiSquareQuantile(probability, 1) * robot.covariance(2, 2));
    // A turn moves the sensor too, by at most its lever arm times the angle.
    const double moved = std::sqrt(chiSquareQuantile(probability, 2) * longest) +
                         turned * sensor.pose.position().norm() + margin;

    return search(at.position(), sensor.max_range + moved, [&](const Vector2& to) {
        const double distance = to.norm();
        if (distance <= moved) return true;  // may stand anywhere around it
        const double aside = std::abs(angleDifference(std::atan2(to.y(), to.x()), at.theta));
        return aside <= 0.5 * sensor.field_of_view + turned + std::asin(moved / distance);
    });
}

}  // namespace slamot

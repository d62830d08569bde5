#include "LaneWorld.h"

#include <algorithm>
#include <cmath>

#include "slamot/core/models/RangeBearing.h"

namespace slamot::bench {
namespace {

constexpr double speed = 1;  // [m/s]
constexpr double range_std = 0.1, bearing_std = 0.01;
// Of the odometry, per root of a metre.
constexpr double along_std = 0.032, across_std = 0.016;

/// [rad] per root of a metre. On a road of 8 km nothing is seen again before the way back: wheels alone would
/// be 0.8 rad off by then, so the road has a good gyro.
double headingStd(WorldLayout layout) {
    return layout == WorldLayout::road ? 0.0016 : 0.0095;
}

DetectionSet emptyScan(Stamp stamp) {
    RangeBearingSet set;
    set.sensors.emplace_back();
    set.sensors[0].max_range = sensor_reach;
    return {stamp, set};
}

}  // namespace

LaneWorld::LaneWorld(WorldLayout layout, int landmarks, double step)
    : step_(step), heading_std_(headingStd(layout)), random_(5, RandomPurpose::test) {
    const GroundPlan plan = groundPlan(layout, landmarks, random_);
    side_ = plan.side;
    cells_ = static_cast<int>(side_ / sensor_reach) + 1;
    landmarks_ = plan.landmarks;
    by_cell_.resize(static_cast<std::size_t>(cells_ * cells_));
    for (std::size_t i = 0; i < landmarks_.size(); ++i)
        by_cell_[cellOf(landmarks_[i])].push_back(static_cast<int>(i));
    drive(plan.corners);
}

void LaneWorld::drive(std::vector<Vector2> corners) {
    for (std::size_t i = corners.size() - 1; i-- > 0;) corners.push_back(corners[i]);
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const Vector2 way = corners[i + 1] - corners[i];
        const int steps = static_cast<int>(way.norm() / step_);
        for (int k = 0; k < steps; ++k) {
            const Vector2 p = corners[i] + way * k / steps;
            path_.push_back({p.x(), p.y(), std::atan2(way.y(), way.x())});
        }
    }
}

std::size_t LaneWorld::cellOf(const Vector2& p) const {
    return static_cast<std::size_t>(static_cast<int>(p.x() / sensor_reach) * cells_ +
                                    static_cast<int>(p.y() / sensor_reach));
}

std::size_t LaneWorld::middle() const {
    const Vector2 centre(0.45 * side_, 0.5 * side_);
    const auto half = path_.begin() + static_cast<std::ptrdiff_t>(path_.size() / 2);
    const auto nearest = std::min_element(path_.begin(), half, [&](const Pose2& a, const Pose2& b) {
        return (a.position() - centre).squaredNorm() < (b.position() - centre).squaredNorm();
    });
    return static_cast<std::size_t>(nearest - path_.begin());
}

Stamp LaneWorld::stamp(std::size_t step) const {
    return Stamp::fromSeconds(step_ / speed * static_cast<double>(step));
}

OdometryIncrement LaneWorld::odometry(std::size_t k) {
    const Pose2 moved = inverse(path_[k - 1]) * path_[k];
    const double root = std::sqrt(step_);
    OdometryIncrement out;
    out.t0 = stamp(k - 1);
    out.t1 = stamp(k);
    out.entry_seconds = out.seconds();
    out.increment =
        Pose2{moved.x + along_std * root * random_.normal(), moved.y + across_std * root * random_.normal(),
              wrapAngle(moved.theta + heading_std_ * root * random_.normal())};
    return out;
}

RangeBearingDetection LaneWorld::detect(const Pose2& robot, const Vector2& object, ObjectKind kind,
                                        int source) const {
    const Vector2 z = rangeBearing<double>(robot.vector(), object, Pose2{});
    RangeBearingDetection detection;
    detection.range = z.x();
    detection.bearing = z.y();
    detection.covariance = Vector2(range_std * range_std, bearing_std * bearing_std).asDiagonal();
    detection.kind = kind;
    detection.source = {source};
    return detection;
}

void LaneWorld::addNoise(RangeBearingDetection& detection) {
    detection.range += range_std * random_.normal();
    detection.bearing = wrapAngle(detection.bearing + bearing_std * random_.normal());
}

DetectionSet LaneWorld::look(std::size_t k) {
    DetectionSet scan = emptyScan(stamp(k));
    auto& detections = std::get<RangeBearingSet>(scan.measurements).detections;
    const Pose2& robot = path_[k];
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y) {
            const Vector2 cell = robot.position() + sensor_reach * Vector2(x, y);
            if (cell.minCoeff() < 0 || cell.maxCoeff() >= cells_ * sensor_reach) continue;
            for (const int i : by_cell_[cellOf(cell)]) {
                const Vector2& landmark = landmarks_[static_cast<std::size_t>(i)];
                if ((landmark - robot.position()).norm() > sensor_reach) continue;
                detections.push_back(detect(robot, landmark, ObjectKind::landmark, i));
                addNoise(detections.back());
            }
        }
    return scan;
}

DetectionSet LaneWorld::lookAtAll(std::size_t k) const {
    DetectionSet scan = emptyScan(stamp(k));
    auto& detections = std::get<RangeBearingSet>(scan.measurements).detections;
    for (std::size_t i = 0; i < landmarks_.size(); ++i)
        detections.push_back(detect(path_[k], landmarks_[i], ObjectKind::landmark, static_cast<int>(i)));
    return scan;
}

void LaneWorld::addMovers(int count, std::size_t k, DetectionSet& seen) {
    auto& detections = std::get<RangeBearingSet>(seen.measurements).detections;
    const Pose2& robot = path_[k];
    for (int j = 0; j < count; ++j) {
        const double part = (j + 1.0) / (count + 1.0), radius = sensor_reach * (0.2 + 0.7 * part);
        const double turn = (j % 2 == 0 ? 1 : -1) * speed / radius * stamp(k).seconds() + 2.4 * j;
        const Vector2 mover = robot.position() + radius * Vector2(std::cos(turn), std::sin(turn));
        detections.push_back(detect(robot, mover, ObjectKind::mover, j));
        addNoise(detections.back());
    }
}

}  // namespace slamot::bench

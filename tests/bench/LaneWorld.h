#pragma once
// The world of the benchmarks: evenly strewn landmarks along lanes that are driven there and back, so that
// all of the map is seen twice.
#include <cstddef>
#include <vector>

#include "WorldLayout.h"
#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot::bench {

/// The robot drives at 1 m/s and makes one scan a step.
class LaneWorld {
  public:
    /// step: [m] between scans.
    LaneWorld(WorldLayout layout, int landmarks, double step);

    const std::vector<Pose2>& path() const { return path_; }
    bool secondPass(std::size_t step) const { return 2 * step > path_.size(); }
    /// A step of the first pass near the centre of the map.
    std::size_t middle() const;
    Stamp stamp(std::size_t step) const;

    /// From step - 1 to step, with noise.
    OdometryIncrement odometry(std::size_t step);
    /// Landmarks within reach, with noise.
    DetectionSet look(std::size_t step);
    /// Every landmark there is, without noise, whatever the reach: fills a map at once.
    DetectionSet lookAtAll(std::size_t step) const;
    /// Adds movers to what is seen at `step`: they circle around the robot within the sensor's reach, each at
    /// 1 m/s and a distance of its own.
    void addMovers(int count, std::size_t step, DetectionSet& seen);

  private:
    std::size_t cellOf(const Vector2& p) const;
    void drive(std::vector<Vector2> corners);
    RangeBearingDetection detect(const Pose2& robot, const Vector2& object, ObjectKind kind,
                                 int source) const;
    void addNoise(RangeBearingDetection& detection);

    double step_;         ///< [m]
    double heading_std_;  ///< [rad] of the odometry, per root of a metre
    RandomStream random_;
    double side_ = 0;  ///< [m]
    int cells_ = 0;    ///< along a side, each as wide as the reach
    std::vector<Vector2> landmarks_;
    std::vector<std::vector<int>> by_cell_;
    std::vector<Pose2> path_;
};

}  // namespace slamot::bench

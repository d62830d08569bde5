#pragma once
// A sensor as it stands in the world with one particle: what is the same for all features that it may see.
#include "slamot/core/particles/ParticleScan.h"
#include "slamot/core/particles/PointSight.h"

namespace slamot {

class StandingSensor {
  public:
    StandingSensor(const PoseBelief& pose, const ScanView& view);

    const Vector2& position() const { return position_; }
    /// [m] within which it may see anything.
    double reach() const;
    /// Cheap: false for what lies clearly beside the field of view.
    bool mayShow(const GaussianPoint& point) const;
    /// By Jacobians: as PointSight's `sightOf`, at the price of a root and an arc tangent.
    PointSight sightOf(const GaussianPoint& point) const;
    /// Whether a point lies within the sensor's limits.
    bool covers(const Vector2& point) const;
    Vector2 pointOf(const Vector2& z) const;
    /// Probability that it lies within the sensor's limits, which are soft: poses of particles are not that
    /// exact.
    double inView(const PointSight& sight) const;

  private:
    const ScanView& view_;
    Vector2 position_, axis_;                      ///< in the world; axis: where bearings are 0
    double half_view_;                             ///< [rad], half the field of view and what may be beyond
    double cos_half_view_;                         ///< -1 all round
    double cos_half_limit_;                        ///< of the field of view itself; -1 all round
    Eigen::Matrix<double, 2, 3> position_factor_;  ///< d position / d xi of the pose
    Eigen::RowVector3d heading_factor_;            ///< d heading / d xi
};

}  // namespace slamot

#pragma once
// A scan as the densities of all particles look at it: what no particle changes is worked out once.
#include <cmath>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/particles/ParticleScan.h"
#include "slamot/core/particles/PhdParameters.h"
#include "slamot/core/particles/PointSight.h"

namespace slamot {

/// A batch without the identities that the log gives: a density has no use for them.
DetectionSet withoutIdentities(DetectionSet set);

struct PhdSight : ScanSight {
    /// Heavier components are rare.
    static constexpr double ordinary_weight = 2;

    explicit PhdSight(const ScanSight& sight) : ScanSight(sight) {}

    Vector2 point;        ///< where it points to, in the sensor's frame [m]
    double variance;      ///< sum of its noise's variances there [m^2]
    double clutter;       ///< c(z) [1/(m rad)]
    double widest;        ///< NIS beyond which a component of ordinary weight has no part in it
    GaussianPoint start;  ///< the landmark that it is the first sight of, in the robot's frame
};

/// A sensor's field of view, with margins.
class PhdView {
  public:
    PhdView(const ScanView& view, const PhdMapParameters& parameters);

    Pose2 sensor;  ///< T_robot_sensor
    bool looks;    ///< for landmarks
    /// Whether it may detect what lies at `at` in its frame [m].
    bool maySee(const Vector2& at) const { return contains(outer_, at); }
    /// Whether it would.
    bool surelySees(const Vector2& at) const { return contains(inner_, at); }

  private:
    struct Limits {
        double nearest, farthest;  ///< [m]
        double cosine;             ///< of half the field of view; -2: all round
    };
    static bool contains(const Limits& limits, const Vector2& at) {
        const double squared = at.squaredNorm();
        if (squared < limits.nearest * limits.nearest || squared > limits.farthest * limits.farthest)
            return false;
        return at.x() >= limits.cosine * std::sqrt(squared);
    }

    Limits outer_, inner_;
};

struct PhdScan {
    PhdScan() = default;
    PhdScan(const ParticleScan& scan, const PhdMapParameters& parameters, GaussianTransform transform);

    const PhdView& viewOf(const PhdSight& sight) const { return views[static_cast<std::size_t>(sight.view)]; }

    Stamp now;
    double reach = 0;  ///< [m] from the robot's origin within which anything may be detected
    std::vector<PhdSight> sights;
    std::vector<PhdView> views;
};

}  // namespace slamot

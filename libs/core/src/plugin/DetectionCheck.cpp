#include "DetectionCheck.h"

#include "slamot/core/estimation/Definiteness.h"

namespace slamot {

std::string problemOf(const RangeBearingDetection& d, std::size_t sensors) {
    if (!d.z().allFinite()) return "is not finite";
    if (d.range <= 0) return "has a range that is not positive";
    if (!isPositiveDefinite(d.covariance)) return "has a covariance that is not positive definite";
    if (d.sensor < 0 || static_cast<std::size_t>(d.sensor) >= sensors) return "names no sensor of its set";
    return {};
}

}  // namespace slamot

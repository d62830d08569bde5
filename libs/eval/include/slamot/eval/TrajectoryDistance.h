#pragma once
// T-GOSPA: one distance between the whole tracks and the whole trajectories of the targets.
#include <cstdint>

#include "slamot/eval/TrackingScene.h"

namespace slamot::eval {

/// Garcia-Fernandez, Rahmathullah and Svensson 2020, the metric of multi-dimensional assignment.
struct TrajectoryDistance {
    std::int64_t stamps = 0;
    /// [m], over all stamps; and the root mean power over them, which does not grow with the length of a run:
    /// per_stamp^p = total^p / stamps.
    double total = 0, per_stamp = 0;
    /// Per stamp [m^p]; they add up to per_stamp^p.
    double localisation_part = 0, missed_part = 0, false_part = 0, switch_part = 0;
    /// A target that gets or loses a track is half a switch.
    double switches = 0;
    /// The metric lies in [lower_bound, total]; equal where the search was exhaustive.
    double lower_bound = 0;
};

/// How far the search goes before it gives up courses and widens the bound instead.
struct TrajectorySearch {
    /// Courses held for one group of objects, and matchings of a group looked at in one stamp.
    std::size_t most_courses = 128, most_matchings = 256;
};

/// Order p >= 1, cutoff c > 0 [m], penalty of a switch gamma > 0 [m].
TrajectoryDistance trajectoryDistance(const TrackingScene& scene, double p, double c, double gamma,
                                      const TrajectorySearch& search = {});

}  // namespace slamot::eval

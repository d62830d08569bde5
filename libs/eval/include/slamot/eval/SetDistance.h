#pragma once
// Distances between an estimated and a true set of points: localisation and number in one figure.
#include <cstdint>
#include <vector>

#include "slamot/core/data/Pose2.h"
#include "slamot/eval/Measured.h"
#include "slamot/eval/Options.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::eval {

using Points = std::vector<Vector2>;

/// Schuhmacher, Vo and Vo 2008. All in metres; total^p = localisation^p + cardinality^p.
struct Ospa {
    double total = 0, localisation = 0, cardinality = 0;
};

/// Rahmathullah, Garcia-Fernandez and Svensson 2017 with alpha = 2. `total` in metres; total^p is the sum of
/// the parts, in metres^p.
struct Gospa {
    double total = 0, localisation_part = 0, missed_part = 0, false_part = 0;
    double matched_count = 0, missed_count = 0, false_count = 0;
};

struct SetDistance {
    Ospa ospa;
    Gospa gospa;
};

/// Euclidean base distance, order p >= 1, cutoff c > 0 [m].
SetDistance setDistance(const Points& estimates, const Points& truths, double p, double c);

/// Means over stamps of every field of SetDistance.
struct TrackSetDistance {
    std::int64_t stamps = 0;
    /// Stamps left out: a target's truth has a gap there, so the true set is unknown.
    std::int64_t stamps_in_gaps = 0;
    SetDistance mean;
};
/// Over the run's stamps, truth being every target present, seen or not.
Measured<TrackSetDistance> trackSetDistance(const RunRecord& run, const Truth& truth,
                                            const EvaluationOptions& options);

/// The map at the end of the run, truth being every landmark, seen or not.
Measured<SetDistance> landmarkSetDistance(const RunRecord& run, const Truth& truth,
                                          const EvaluationOptions& options);

}  // namespace slamot::eval

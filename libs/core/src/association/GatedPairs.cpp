#include "slamot/core/association/GatedPairs.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace slamot {
namespace {

double logDensity(const Linearisation& pair) {
    return -0.5 * (pair.nis + std::log(pair.S.determinant())) - std::log(2.0 * pi);
}

}  // namespace

GatedPairs gatedPairs(const JointView& state, const std::vector<BlockId>& objects,
                      const RangeBearingSet& seen, const std::vector<int>& detections,
                      Consistency consistency, PairGates& gates, const MayPair& may_pair) {
    const double gate = gates(1);
    std::vector<Candidate> candidates;
    std::vector<LinearMeasurement> measurements;
    std::map<int, std::vector<std::optional<ExpectedSight>>> by_sensor;
    for (const int d : detections) {
        const RangeBearingDetection& detection = seen.detections[static_cast<std::size_t>(d)];
        const Pose2& sensor = seen.sensorOf(detection).pose;
        auto& expected = by_sensor[detection.sensor];
        expected.resize(objects.size());
        for (std::size_t o = 0; o < objects.size(); ++o) {
            if (may_pair && !may_pair(d, static_cast<int>(o))) continue;
            if (!expected[o]) expected[o] = expectedSight(state, objects[o], sensor, consistency);
            if (!rowsLieWithin(gate, expected[o]->detection, detection)) continue;
            const Linearisation pair = expected[o]->with(detection);
            if (!(pair.nis <= gate)) continue;
            candidates.push_back({d, static_cast<int>(o), pair.nis, logDensity(pair)});
            measurements.push_back(pair.measurement);
        }
    }
    return {AssociationProblem(static_cast<int>(seen.detections.size()), static_cast<int>(objects.size()),
                               std::move(candidates)),
            std::move(measurements)};
}

}  // namespace slamot

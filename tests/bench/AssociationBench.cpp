// Association of one batch against the size of the map: landmarks in view from the index, gates, and a
// method. Then what ambiguity costs: joint compatibility among duplicates, marginals of entangled clusters.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "MowerWorld.h"
#include "slamot/core/association/AssociationMarginals.h"
#include "slamot/core/association/GatedPairs.h"
#include "slamot/core/association/GlobalNearestNeighbour.h"
#include "slamot/core/association/JointCompatibility.h"
#include "slamot/core/association/LandmarkIndex.h"
#include "slamot/core/association/LinearInnovations.h"
#include "slamot/core/association/NearestNeighbour.h"
#include "slamot/core/association/SequentialCompatibility.h"
#include "slamot/core/models/RangeBearing.h"

namespace slamot {
namespace {

constexpr int node_budget = 1000, state_budget = 2000;

/// A robot at the origin and landmarks first seen from there, so that all are correlated: P_ab = G_a P_R
/// G_b^t, plus their own on the diagonal. Computed when asked for: no covariance of 10,000 landmarks fits
/// into memory.
class CorrelatedMap : public JointView {
  public:
    std::vector<Vector2> landmarks;  ///< block b is number b - 1

    BlockVector mean(BlockId b) const override {
        if (b == robot_block) return Vector3::Zero();
        return landmarks[static_cast<std::size_t>(b - 1)];
    }
    BlockMatrix covariance(BlockId a, BlockId b) const override {
        BlockMatrix P = G(a) * robotCovariance() * G(b).transpose();
        if (a == b && a != robot_block) P += 0.0025 * Matrix2::Identity();
        return P;
    }
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>&) const override { return {}; }
    static Matrix3 robotCovariance() { return Vector3(0.0025, 0.0025, 0.0001).asDiagonal(); }

  private:
    BlockMatrix G(BlockId b) const {
        if (b == robot_block) return Matrix3::Identity();
        BlockMatrix out(2, 3);
        out << Matrix2::Identity(), quarterTurn() * mean(b);
        return out;
    }
};

/// Landmarks as dense as in the other benchmarks, evenly strewn around the robot, and one batch: what is in
/// view, missed one time in ten, and ten false detections.
struct Scene {
    CorrelatedMap map;
    LandmarkIndex index;
    RangeBearingSet seen;
    std::vector<int> all;

    explicit Scene(int count) {
        RandomStream random(1, RandomPurpose::test);
        RangeBearingSensor sensor;
        sensor.max_range = bench::MowerWorld::reach;
        seen.sensors.push_back(sensor);
        // From the centre outwards, each in a ring of equal area: all maps have the same landmarks in view.
        RandomStream positions(2, RandomPurpose::world);
        for (int i = 0; i < count; ++i) {
            const double r = std::sqrt((i + positions.uniform()) / (pi * bench::MowerWorld::density));
            const double b = positions.uniform(-pi, pi);
            map.landmarks.emplace_back(r * std::cos(b), r * std::sin(b));
            index.set(i + 1, map.landmarks.back());
            if (r < sensor.max_range && random.uniform() < 0.9)
                add(r + random.normal(0, 0.1), b + random.normal(0, 0.01));
        }
        for (int i = 0; i < 10; ++i) add(random.uniform(0, sensor.max_range), random.uniform(-pi, pi));
    }
    void add(double range, double bearing) {
        RangeBearingDetection detection;
        detection.range = range;
        detection.bearing = wrapAngle(bearing);
        detection.covariance = Vector2(0.01, 1e-4).asDiagonal();
        all.push_back(static_cast<int>(seen.detections.size()));
        seen.detections.push_back(detection);
    }
    std::vector<BlockId> inView() const {
        return index.inView({{}, CorrelatedMap::robotCovariance()}, seen.sensors[0], 0.99, 0.5);
    }
    DetectionModel model(const AssociationProblem& problem) const {
        return {std::vector<double>(static_cast<std::size_t>(problem.objects()), 0.9),
                std::vector<double>(static_cast<std::size_t>(problem.detections()),
                                    clutterDensity(10, seen.sensors[0])),
                0.99};
    }
};

/// What a step does before any method: index and gates.
void findCandidates(benchmark::State& bench) {
    const Scene scene(static_cast<int>(bench.range(0)));
    PairGates gates(0.99);
    for (auto _ : bench) {
        const GatedPairs gated =
            gatedPairs(scene.map, scene.inView(), scene.seen, scene.all, Consistency::classic, gates);
        bench.counters["candidates"] = gated.problem.candidates();
    }
    bench.counters["in_view"] = static_cast<double>(scene.inView().size());
    bench.counters["detections"] = static_cast<double>(scene.all.size());
}

/// A whole step: candidates and a method.
template <class Method>
void step(benchmark::State& bench, const Method& method) {
    const Scene scene(static_cast<int>(bench.range(0)));
    PairGates gates(0.99);
    for (auto _ : bench) {
        const GatedPairs gated =
            gatedPairs(scene.map, scene.inView(), scene.seen, scene.all, Consistency::classic, gates);
        LinearInnovations innovations(scene.map, gated.measurements);
        benchmark::DoNotOptimize(method(scene, gated.problem, innovations, gates));
    }
}

void nearest(benchmark::State& bench) {
    step(bench, [](const Scene&, const AssociationProblem& problem, JointInnovations&, PairGates&) {
        return nearestNeighbour(problem);
    });
}
void sequential(benchmark::State& bench) {
    step(bench, [](const Scene&, const AssociationProblem& problem, JointInnovations& nu, PairGates& gates) {
        return sequentialCompatibility(problem, nu, gates);
    });
}
void joint(benchmark::State& bench) {
    step(bench, [](const Scene&, const AssociationProblem& problem, JointInnovations& nu, PairGates& gates) {
        return jointCompatibility(problem, nu, gates, node_budget);
    });
}
void global(benchmark::State& bench) {
    step(bench, [](const Scene& scene, const AssociationProblem& problem, JointInnovations&, PairGates&) {
        return globalNearestNeighbour(problem, scene.model(problem));
    });
}
void marginals(benchmark::State& bench) {
    step(bench, [](const Scene& scene, const AssociationProblem& problem, JointInnovations&, PairGates&) {
        return associationMarginals(problem, scene.model(problem), state_budget);
    });
}

/// After an update: every landmark in view is told its new position.
void tellCorrections(benchmark::State& bench) {
    Scene scene(static_cast<int>(bench.range(0)));
    const std::vector<BlockId> in_view = scene.inView();
    RandomStream random(3, RandomPurpose::test);
    for (auto _ : bench)
        for (const BlockId b : in_view)
            scene.index.set(b, scene.map.mean(b) + 0.02 * Vector2(random.normal(), random.normal()));
}

/// A new landmark, and its removal.
void addAndRemove(benchmark::State& bench) {
    Scene scene(static_cast<int>(bench.range(0)));
    RandomStream random(3, RandomPurpose::test);
    for (auto _ : bench) {
        scene.index.set(-1, {random.uniform(-20, 20), random.uniform(-20, 20)});
        scene.index.remove(-1);
    }
}

/// 12 landmarks 0.25 m apart, a noisy detection of each and four false ones, against the node budget.
void duplicates(benchmark::State& bench) {
    CorrelatedMap map;
    std::vector<BlockId> blocks;
    Scene scene(0);
    scene.seen.detections.clear();
    scene.all.clear();
    RandomStream random(4, RandomPurpose::test);
    for (int i = 0; i < 12; ++i) {
        map.landmarks.emplace_back(10, 0.25 * (i - 5.5));
        blocks.push_back(i + 1);
        const Vector2 at = map.landmarks.back() + Vector2(random.normal(0, 0.1), random.normal(0, 0.2));
        scene.add(at.norm(), std::atan2(at.y(), at.x()));
    }
    for (int i = 0; i < 4; ++i) scene.add(random.normal(10, 0.3), random.uniform(-0.15, 0.15));
    for (auto& detection : scene.seen.detections) detection.covariance(1, 1) = 4e-4;
    PairGates gates(0.99);
    const GatedPairs gated = gatedPairs(map, blocks, scene.seen, scene.all, Consistency::classic, gates);
    LinearInnovations innovations(map, gated.measurements);
    for (auto _ : bench) {
        const JointCompatibility found =
            jointCompatibility(gated.problem, innovations, gates, static_cast<int>(bench.range(0)));
        bench.counters["nodes"] = found.nodes;
        bench.counters["pairs"] = found.pairing.pairs();
        bench.counters["nis"] = found.nis;
    }
    bench.counters["candidates"] = gated.problem.candidates();
}

/// Every detection fits every object: as entangled as a cluster can be.
void entangled(benchmark::State& bench, int budget) {
    const int n = static_cast<int>(bench.range(0));
    RandomStream random(5, RandomPurpose::test);
    std::vector<Candidate> candidates;
    for (int d = 0; d < n; ++d)
        for (int o = 0; o < n; ++o) candidates.push_back({d, o, 1, random.uniform(-3, 3)});
    const AssociationProblem problem(n, n, candidates);
    const DetectionModel model{std::vector<double>(static_cast<std::size_t>(n), 0.9),
                               std::vector<double>(static_cast<std::size_t>(n), 0.1), 1};
    for (auto _ : bench) {
        const AssociationMarginals found = associationMarginals(problem, model, budget);
        bench.counters["states"] = found.states;
        bench.counters["rounds"] = found.rounds;
    }
}
void entangledExact(benchmark::State& bench) {
    entangled(bench, 1 << 30);
}
void entangledLoopy(benchmark::State& bench) {
    entangled(bench, 0);
}

#define AGAINST_THE_MAP(NAME) \
    BENCHMARK(NAME)->Arg(100)->Arg(300)->Arg(1000)->Arg(3000)->Arg(10000)->Unit(benchmark::kMicrosecond)
AGAINST_THE_MAP(findCandidates);
AGAINST_THE_MAP(nearest);
AGAINST_THE_MAP(sequential);
AGAINST_THE_MAP(joint);
AGAINST_THE_MAP(global);
AGAINST_THE_MAP(marginals);
AGAINST_THE_MAP(tellCorrections);
AGAINST_THE_MAP(addAndRemove);
BENCHMARK(duplicates)->RangeMultiplier(10)->Range(1, 100000)->Unit(benchmark::kMicrosecond);
BENCHMARK(entangledExact)->DenseRange(2, 12, 2)->Unit(benchmark::kMicrosecond);
BENCHMARK(entangledLoopy)->DenseRange(2, 12, 2)->Arg(30)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slamot

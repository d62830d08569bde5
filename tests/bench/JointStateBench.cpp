// Prediction and update of the dense joint state against the size of the map.
#include <benchmark/benchmark.h>

#include <cmath>

#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {
namespace {

constexpr int seen = 25;  // landmarks in one batch

/// A robot among `count` landmarks on a grid, 2 m apart, all added from one pose: fully correlated.
DenseJointBank mapOf(int count, Consistency consistency, std::vector<BlockId>& landmarks) {
    DenseJointBank state(Vector3::Zero(), 0.01 * Matrix3::Identity(), consistency);
    const int side = static_cast<int>(std::ceil(std::sqrt(count)));
    for (int i = 0; i < count; ++i) {
        const Vector2 p(2.0 * (i % side) + 1.0, 2.0 * (i / side) - side + 0.5);
        Eigen::Matrix<double, 2, 3> G;
        G << 1, 0, -p.y(), 0, 1, p.x();
        landmarks.push_back(state.augment(BlockKind::landmark, {p, G, 0.01 * Matrix2::Identity()}));
    }
    return state;
}

std::vector<LinearMeasurement> batchOf(const JointView& state, const std::vector<BlockId>& landmarks) {
    std::vector<LinearMeasurement> batch;
    const std::size_t stride = landmarks.size() / seen;
    for (std::size_t i = 0; i < seen; ++i) {
        const BlockId block = landmarks[i * stride];
        RangeBearingDetection detection;
        const Vector2 p = state.mean(block).head<2>();
        detection.range = p.norm();
        detection.bearing = std::atan2(p.y(), p.x());
        detection.covariance = Vector2(0.01, 1e-4).asDiagonal();
        batch.push_back(linearise(state, block, detection, {}, Consistency::classic).measurement);
    }
    return batch;
}

void update(benchmark::State& bench, Consistency consistency) {
    std::vector<BlockId> landmarks;
    DenseJointBank bank = mapOf(static_cast<int>(bench.range(0)), consistency, landmarks);
    const auto batch = batchOf(bank.mode(0), landmarks);
    for (auto _ : bench) bank.mode(0).update(batch);
}

void updateClassic(benchmark::State& bench) {
    update(bench, Consistency::classic);
}
void updateInvariant(benchmark::State& bench) {
    update(bench, Consistency::invariant);
}

void predict(benchmark::State& bench) {
    std::vector<BlockId> landmarks;
    DenseJointBank bank = mapOf(static_cast<int>(bench.range(0)), Consistency::classic, landmarks);
    const Matrix3 F = Matrix3::Identity(), Q = 1e-6 * Matrix3::Identity();
    for (auto _ : bench) bank.mode(0).propagate(robot_block, Vector3::Zero(), F, Q);
}

BENCHMARK(updateClassic)->RangeMultiplier(2)->Range(50, 1600)->Unit(benchmark::kMicrosecond);
BENCHMARK(updateInvariant)->RangeMultiplier(2)->Range(50, 1600)->Unit(benchmark::kMicrosecond);
BENCHMARK(predict)->RangeMultiplier(2)->Range(50, 1600)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slamot

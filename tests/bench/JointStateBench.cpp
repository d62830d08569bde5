// The two engines of the joint state against the size of the map: an update and a prediction alone. Whole
// steps over whole runs: map_size_bench.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "WorldLayout.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {
namespace {

constexpr int seen = 40;  // landmarks in one batch

/// A robot in the middle of `count` landmarks on a grid of the density above, all added from one pose: fully
/// correlated. The nearest come first; beyond the first 150 all are put away.
std::vector<BlockId> fill(JointBank& bank, int count) {
    const int side = static_cast<int>(std::ceil(std::sqrt(count)));
    const double spacing = 1.0 / std::sqrt(bench::landmark_density);
    std::vector<Vector2> points;
    for (int i = 0; i < side * side; ++i)
        points.push_back(spacing * Vector2(i % side - 0.5 * side + 0.3, i / side - 0.5 * side + 0.4));
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
    std::vector<BlockId> landmarks;
    for (int i = 0; i < count; ++i) {
        const Vector2& p = points[static_cast<std::size_t>(i)];
        Eigen::Matrix<double, 2, 3> G;
        G << 1, 0, -p.y(), 0, 1, p.x();
        landmarks.push_back(bank.augment(BlockKind::landmark, {p, G, 0.01 * Matrix2::Identity()}));
        if (i < 150 || i % 50 != 49) continue;
        bank.commit({landmarks.end() - 50, landmarks.end()}, Eigen::VectorXd::Ones(1));
    }
    return landmarks;
}

std::vector<LinearMeasurement> batchOf(const JointView& state, const std::vector<BlockId>& landmarks) {
    std::vector<LinearMeasurement> batch;
    for (std::size_t i = 0; i < seen; ++i) {
        RangeBearingDetection detection;
        const Vector2 p = state.mean(landmarks[i]).head<2>();
        detection.range = p.norm();
        detection.bearing = std::atan2(p.y(), p.x());
        detection.covariance = Vector2(0.01, 1e-4).asDiagonal();
        batch.push_back(linearise(state, landmarks[i], detection, {}, Consistency::classic).measurement);
    }
    return batch;
}

template <class Bank, Consistency consistency>
void update(benchmark::State& bench) {
    Bank bank(Vector3::Zero(), 0.01 * Matrix3::Identity(), consistency);
    const auto landmarks = fill(bank, static_cast<int>(bench.range(0)));
    const auto batch = batchOf(bank.mode(0), landmarks);
    for (auto _ : bench) bank.mode(0).update(batch);
}

template <class Bank>
void predict(benchmark::State& bench) {
    Bank bank(Vector3::Zero(), 0.01 * Matrix3::Identity(), Consistency::invariant);
    fill(bank, static_cast<int>(bench.range(0)));
    const Matrix3 F = Matrix3::Identity(), Q = 1e-6 * Matrix3::Identity();
    for (auto _ : bench) bank.mode(0).propagate(robot_block, Vector3::Zero(), F, Q);
}

BENCHMARK_TEMPLATE(update, DenseJointBank, Consistency::classic)
    ->RangeMultiplier(2)
    ->Range(50, 1600)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(update, DenseJointBank, Consistency::invariant)
    ->RangeMultiplier(2)
    ->Range(50, 1600)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(update, CompressedJointBank, Consistency::classic)
    ->RangeMultiplier(2)
    ->Range(50, 1600)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(update, CompressedJointBank, Consistency::invariant)
    ->RangeMultiplier(2)
    ->Range(50, 1600)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(predict, DenseJointBank)
    ->RangeMultiplier(2)
    ->Range(50, 1600)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(predict, CompressedJointBank)
    ->RangeMultiplier(2)
    ->Range(50, 1600)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace slamot

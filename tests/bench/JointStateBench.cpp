// The two engines of the joint state against the size of the map: an update and a prediction alone, and whole
// runs of the joint filter over a map that is seen twice.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "slamot/core/estimation/JointFilter.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"
#include "slamot/core/models/RangeBearing.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace {

constexpr int seen = 40;      // landmarks in one batch, about
constexpr double reach = 20;  // [m]
const double density = seen / (pi * reach * reach);

/// [ms] of the calling thread: what others do on this machine does not count.
double processorTime() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// A robot in the middle of `count` landmarks on a grid of the density above, all added from one pose: fully
/// correlated. The nearest come first; beyond the first 150 all are put away.
std::vector<BlockId> fill(JointBank& bank, int count) {
    const int side = static_cast<int>(std::ceil(std::sqrt(count)));
    const double spacing = 1.0 / std::sqrt(density);
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

/// A square world with landmarks strewn evenly, mowed in lanes there and back.
class Mower {
  public:
    Mower(int count, double step) : side_(std::sqrt(count / density)), random_(5, RandomPurpose::test) {
        cells_ = static_cast<int>(side_ / reach) + 1;
        by_cell_.resize(static_cast<std::size_t>(cells_ * cells_));
        for (int i = 0; i < count; ++i) {
            landmarks_.emplace_back(random_.uniform(0, side_), random_.uniform(0, side_));
            by_cell_[cellOf(landmarks_.back())].push_back(i);
        }
        const int lanes = std::max(1, static_cast<int>(std::round(side_ / 36)));
        std::vector<Vector2> corners;
        for (int i = 0; i < lanes; ++i)
            for (const bool end : {false, true})
                corners.emplace_back((i % 2 == 0) == end ? side_ : 0.0, (i + 0.5) * side_ / lanes);
        for (std::size_t i = corners.size() - 1; i-- > 0;) corners.push_back(corners[i]);
        for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
            const Vector2 way = corners[i + 1] - corners[i];
            const int steps = static_cast<int>(way.norm() / step);
            for (int k = 0; k < steps; ++k) {
                const Vector2 p = corners[i] + way * k / steps;
                path_.push_back({p.x(), p.y(), std::atan2(way.y(), way.x())});
            }
        }
    }

    const std::vector<Pose2>& path() const { return path_; }

    OdometryIncrement odometry(std::size_t k) {
        const Pose2 moved = inverse(path_[k - 1]) * path_[k];
        OdometryIncrement out;
        out.t0 = Stamp::fromSeconds(0.1 * static_cast<double>(k - 1));
        out.t1 = Stamp::fromSeconds(0.1 * static_cast<double>(k));
        out.entry_seconds = 0.1;
        out.increment = Pose2{moved.x + 0.01 * random_.normal(), moved.y + 0.005 * random_.normal(),
                              wrapAngle(moved.theta + 0.003 * random_.normal())};
        return out;
    }

    DetectionSet look(std::size_t k) {
        RangeBearingSet set;
        set.sensors.emplace_back();
        set.sensors[0].max_range = reach;
        const Pose2& pose = path_[k];
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y) {
                const Vector2 cell = pose.position() + reach * Vector2(x, y);
                if (cell.minCoeff() < 0 || cell.maxCoeff() >= cells_ * reach) continue;
                for (const int i : by_cell_[cellOf(cell)]) {
                    const Vector2& p = landmarks_[static_cast<std::size_t>(i)];
                    if ((p - pose.position()).norm() > reach) continue;
                    const Vector2 z = rangeBearing<double>(pose.vector(), p, Pose2{});
                    RangeBearingDetection detection;
                    detection.range = z.x() + 0.1 * random_.normal();
                    detection.bearing = wrapAngle(z.y() + 0.01 * random_.normal());
                    detection.covariance = Vector2(0.01, 1e-4).asDiagonal();
                    detection.kind = ObjectKind::landmark;
                    detection.source = {i};
                    set.detections.push_back(detection);
                }
            }
        return {Stamp::fromSeconds(0.1 * static_cast<double>(k)), set};
    }

  private:
    std::size_t cellOf(const Vector2& p) const {
        return static_cast<std::size_t>(static_cast<int>(p.x() / reach) * cells_ +
                                        static_cast<int>(p.y() / reach));
    }

    double side_;
    int cells_;
    RandomStream random_;
    std::vector<Vector2> landmarks_;
    std::vector<std::vector<int>> by_cell_;
    std::vector<Pose2> path_;
};

double percentile(std::vector<double>& values, double part) {
    if (values.empty()) return 0;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// Steps of 0.1 m. Steps with a commit, an activation or a regrouping count apart from those between. Times
/// [ms].
void mapSeenTwice(benchmark::State& bench) {
    JointFilterParameters parameters;
    parameters.engine.kind = JointEngine::Kind::compressed;
    for (auto _ : bench) {
        Mower world(static_cast<int>(bench.range(0)), 0.1);
        JointFilter filter(parameters, {});
        filter.start({}, {world.path().front(), 1e-6 * Matrix3::Identity()});
        const auto& bank = dynamic_cast<const CompressedJointBank&>(filter.state());
        std::vector<double> between[2], others[2];
        std::int64_t events = 0;
        for (std::size_t k = 1; k < world.path().size(); ++k) {
            const OdometryIncrement odometry = world.odometry(k);
            const DetectionSet set = world.look(k);
            const double begin = processorTime();
            filter.predict(odometry);
            filter.update(set);
            const double time = processorTime() - begin;
            const std::int64_t now = bank.commits() + bank.activations() + bank.map().regroupings();
            const int pass = 2 * k > world.path().size() ? 1 : 0;
            (now == events ? between : others)[pass].push_back(time);
            events = now;
        }
        for (int pass = 0; pass < 2; ++pass) {
            const std::string name = pass == 0 ? "first_" : "second_";
            bench.counters[name + "p50"] = percentile(between[pass], 0.5);
            bench.counters[name + "p99"] = percentile(between[pass], 0.99);
            bench.counters[name + "max"] = percentile(between[pass], 1.0);
            bench.counters[name + "commits"] = static_cast<double>(others[pass].size());
            bench.counters[name + "commit_p50"] = percentile(others[pass], 0.5);
            bench.counters[name + "commit_max"] = percentile(others[pass], 1.0);
        }
        bench.counters["MB"] = 1e-6 * static_cast<double>(bank.memory());
    }
}

BENCHMARK(mapSeenTwice)->Arg(400)->Arg(1000)->Arg(4000)->Arg(10000)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace slamot

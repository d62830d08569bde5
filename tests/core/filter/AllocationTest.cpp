// Once sizes have settled, a step takes nothing from the heap but the report it hands out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <tuple>
#include <vector>

#include "slamot/core/filter/JointFilter.h"

// Eigen calls malloc directly, so this program's malloc counts; the C library's own stands behind it.
// Sanitizers bring their own, where this test has nothing to say.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define SLAMOT_COUNTS_ALLOCATIONS 0
#else
#define SLAMOT_COUNTS_ALLOCATIONS 1
#endif

namespace {
thread_local bool counting = false;
thread_local int allocations = 0;
}  // namespace

#if SLAMOT_COUNTS_ALLOCATIONS
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_realloc(void* pointer, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
    if (counting) ++allocations;
    return __libc_malloc(size);
}
void* realloc(void* pointer, std::size_t size) {
    if (counting) ++allocations;
    return __libc_realloc(pointer, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
    if (counting) ++allocations;
    return __libc_memalign(alignment, size);
}
}
#endif

namespace slamot {
namespace allocation_test {

template <class Action>
int allocationsOf(const Action& action) {
    allocations = 0;
    counting = true;
    action();
    counting = false;
    return allocations;
}

class Allocations : public ::testing::TestWithParam<std::tuple<Consistency, JointEngine::Kind>> {
  protected:
    void SetUp() override {
        if (!SLAMOT_COUNTS_ALLOCATIONS)
            GTEST_SKIP() << "allocations are counted with the plain C library only";
        std::vector<int> proof;
        ASSERT_EQ(allocationsOf([&] { proof.resize(8); }), 1);
    }
};

/// Every `stride`-th of 300 landmarks on a circle of 20 m, and one mover, seen from the centre.
DetectionSet lookAround(Stamp stamp, int stride) {
    DetectionSet set;
    set.stamp = stamp;
    auto& seen = std::get<RangeBearingSet>(set.measurements);
    seen.sensors.emplace_back();
    const auto add = [&](ObjectKind kind, int id, double range, double bearing) {
        RangeBearingDetection detection;
        detection.range = range;
        detection.bearing = bearing;
        detection.covariance = Vector2(0.01, 1e-4).asDiagonal();
        detection.kind = kind;
        detection.source = SourceId{id};
        seen.detections.push_back(detection);
    };
    for (int i = 0; i < 300; i += stride) add(ObjectKind::landmark, i, 20, wrapAngle(2 * pi * i / 300));
    add(ObjectKind::mover, 0, 5, 0.3);
    return set;
}

TEST_P(Allocations, aStepTakesNothingButItsReport) {
    JointFilterParameters parameters;
    parameters.consistency = std::get<0>(GetParam());
    parameters.engine.kind = std::get<1>(GetParam());
    RobotMotionParameters motion;
    motion.model = RobotMotionModel::increment;
    JointFilter filter(parameters, motion);
    filter.start({0}, {});

    for (int step = 1; step <= 5; ++step) {
        const Stamp before = Stamp::fromSeconds(0.1 * (step - 1)), now = Stamp::fromSeconds(0.1 * step);
        OdometryIncrement odometry;
        odometry.t0 = before;
        odometry.t1 = now;
        const DetectionSet set = lookAround(now, step == 1 ? 1 : 10);
        const int predict = allocationsOf([&] { filter.predict(odometry); });
        UpdateReport report;
        const int update = allocationsOf([&] { report = filter.update(set); });
        if (step < 3) continue;  // the first look builds the map, the second the work space
        ASSERT_EQ(report.innovations.size(), 31u);
        EXPECT_EQ(predict, 0) << "at step " << step;
        EXPECT_EQ(update, 1) << "at step " << step;
    }
}

INSTANTIATE_TEST_SUITE_P(All, Allocations,
                         ::testing::Combine(::testing::Values(Consistency::classic, Consistency::invariant),
                                            ::testing::Values(JointEngine::Kind::dense,
                                                              JointEngine::Kind::compressed)));

}  // namespace allocation_test
}  // namespace slamot

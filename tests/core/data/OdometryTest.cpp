#include <gtest/gtest.h>

#include <stdexcept>

#include "slamot/core/data/Odometry.h"
#include "support/Expect.h"

namespace slamot {
namespace odometry_test {

using test::near;

OdometryIncrement entryOf(const Pose2& increment) {
    OdometryIncrement entry;
    entry.t0 = {17'000'000'000'000'000};
    entry.t1 = {entry.t0.ticks + 3'000'000};
    entry.increment = increment;
    entry.velocity = BodyVelocity{1, 2, 3};
    entry.entry_seconds = 0.3;
    return entry;
}

Stamp inside(const OdometryIncrement& entry, std::int64_t ticks) {
    return {entry.t0.ticks + ticks};
}

TEST(OdometryTest, PiecesComposeToTheWhole) {
    for (const Pose2& increment : {Pose2{1, 0, 0}, Pose2{1, 0.2, 0.4}, Pose2{-1, 0.3, -2.9}, Pose2{0, 0, 1},
                                   Pose2{0.5, 0.1, 1e-7}, Pose2{0.5, 0.1, -1e-7}, Pose2{}, Pose2{0.3, 0, pi}})
        for (const std::int64_t cut : {1L, 1'000'000L, 2'999'999L}) {
            const auto entry = entryOf(increment);
            const auto [before, after] = split(entry, inside(entry, cut));
            const Pose2 whole = before.increment * after.increment;
            EXPECT_TRUE(near(whole.position(), increment.position(), 1e-14));
            EXPECT_NEAR(angleDifference(whole.theta, increment.theta), 0, 1e-14);
            EXPECT_EQ(before.t0, entry.t0);
            EXPECT_EQ(before.t1, inside(entry, cut));
            EXPECT_EQ(after.t0, inside(entry, cut));
            EXPECT_EQ(after.t1, entry.t1);
        }
}

TEST(OdometryTest, TheTwistIsConstant) {
    // Half a circle of radius 1/2 to the left, ending 1 m to the left and facing back; after a third of the
    // time 60 degrees of it: (sin 60 / 2, (1 - cos 60) / 2).
    const auto entry = entryOf({0, 1, pi});
    const auto [before, after] = split(entry, inside(entry, 1'000'000));
    EXPECT_TRUE(near(before.increment.vector(), Vector3(std::sqrt(3.0) / 4, 0.25, pi / 3), 1e-14));
    // Equal shares of time are equal shares of motion: cut the rest in two, each is the first third again.
    const auto [second, third] = split(after, inside(entry, 2'000'000));
    EXPECT_TRUE(near(second.increment.vector(), before.increment.vector(), 1e-14));
    EXPECT_TRUE(near(third.increment.vector(), before.increment.vector(), 1e-14));
}

TEST(OdometryTest, VelocityAndEntryLengthAreKept) {
    const auto entry = entryOf({1, 0, 0.1});
    const auto [before, after] = split(entry, inside(entry, 1'000'000));
    for (const OdometryIncrement& piece : {before, after}) {
        EXPECT_EQ(piece.velocity->vx, 1);
        EXPECT_EQ(piece.velocity->vy, 2);
        EXPECT_EQ(piece.velocity->omega, 3);
        EXPECT_EQ(piece.entry_seconds, 0.3);
    }
}

TEST(OdometryTest, AnEntryWithoutALengthIsItsOwnEntry) {
    OdometryIncrement entry = entryOf({1, 0, 0});
    entry.entry_seconds = 0;
    const auto [before, after] = split(entry, inside(entry, 1'000'000));
    EXPECT_EQ(before.entry_seconds, 0.3);
    EXPECT_EQ(after.entry_seconds, 0.3);
    EXPECT_EQ(split(after, inside(entry, 2'000'000)).before.entry_seconds, 0.3);
}

TEST(OdometryTest, CovariancesAddUp) {
    auto entry = entryOf({1, 0, 0});
    EXPECT_FALSE(split(entry, inside(entry, 1'000'000)).before.covariance);
    entry.covariance = Vector3(3, 6, 9).asDiagonal();
    const auto [before, after] = split(entry, inside(entry, 1'000'000));
    EXPECT_TRUE(near(*before.covariance, Matrix3(Vector3(1, 2, 3).asDiagonal()), 1e-14));
    EXPECT_TRUE(near(*after.covariance, Matrix3(Vector3(2, 4, 6).asDiagonal()), 1e-14));
}

TEST(OdometryTest, RefusesCutsOutside) {
    const auto entry = entryOf({1, 0, 0});
    for (const std::int64_t cut : {-1L, 0L, 3'000'000L, 3'000'001L})
        EXPECT_THROW(split(entry, inside(entry, cut)), std::invalid_argument) << cut;
}

}  // namespace odometry_test
}  // namespace slamot

#include <gtest/gtest.h>

#include "slamot/core/objects/LostTracks.h"

namespace slamot {
namespace lost_tracks_test {

constexpr double t0 = 100;

Vector6 state(double px, double py, double vx, double vy) {
    return (Vector6() << px, py, vx, vy, 0, 0).finished();
}

Matrix6 uncertain(double position_std, double velocity_std) {
    const double p = position_std * position_std, v = velocity_std * velocity_std;
    return Matrix6((Vector6() << p, p, v, v, 0, 0).finished().asDiagonal());
}

LostTrack lost(int id, const Vector6& mean, const Matrix6& covariance = uncertain(0.3, 0.4)) {
    return {TrackId{id}, mean, covariance, Stamp::fromSeconds(t0)};
}

/// Constant velocity without driving noise.
const TargetModel straight{TargetModelKind::cv, 0.0, 0};

TEST(LostTracksTest, TheOneWhosePredictionFitsIsKnownAgain) {
    // After 2 s at (1, 0.5) m/s from (3, 4): at (5, 5).
    LostTracks tracks(0.99, 10);
    tracks.add(lost(4, state(3, 4, 1, 0.5)));
    tracks.add(lost(9, state(30, 4, 1, 0.5)));
    tracks.predict(2, straight);
    EXPECT_EQ(tracks.continuedBy(state(3, 4, 1, 0.5), uncertain(0.1, 0.1)), std::nullopt)
        << "where it was lost it is no more";
    EXPECT_EQ(tracks.continuedBy(state(5, 5, 1, 0.5), uncertain(0.1, 0.1)), TrackId{4});
    EXPECT_EQ(tracks.continuedBy(state(5, 5, 1, 0.5), uncertain(0.1, 0.1)), std::nullopt) << "it has left";
    EXPECT_EQ(tracks.continuedBy(state(32, 5, 1, 0.5), uncertain(0.1, 0.1)), TrackId{9});
}

TEST(LostTracksTest, TheGateIsThatOfPositionAndVelocity) {
    // In each axis, after 2 s: p = 0.09 + 4 * 0.16 = 0.73, pv = 2 * 0.16 = 0.32, v = 0.16; the new one adds
    // 0.01 and 0.04: S = [0.74 0.32; 0.32 0.2], det 0.0456. 99 % of a chi-square of 4 degrees: 13.2767
    // (tables). A difference of d in x alone has d^2 * 0.2 / 0.0456: 13.2767 at d = 1.7398. One of v in vx
    // alone has v^2 * 0.74 / 0.0456: at v = 0.90450. With 2 degrees d = 1.449 would fail already.
    const struct {
        Vector6 offset;
        bool inside;
    } cases[] = {
        {state(1.739, 0, 0, 0), true},  {state(1.741, 0, 0, 0), false}, {state(0, -1.739, 0, 0), true},
        {state(0, 0, 0.904, 0), true},  {state(0, 0, 0.905, 0), false}, {state(0, 0, 0, -0.905), false},
        {state(1.5, 0, 0.6, 0), true},     // as correlated: 1.5^2 0.2 - 2 1.5 0.6 0.32 + 0.6^2 0.74 = 0.140
        {state(1.5, 0, -0.6, 0), false}};  // against it: 1.292 / 0.0456 = 28.3
    for (const auto& [offset, inside] : cases) {
        LostTracks tracks(0.99, 10);
        tracks.add(lost(1, state(3, 4, 1, 0.5)));
        tracks.predict(2, straight);
        const auto found = tracks.continuedBy(state(5, 5, 1, 0.5) + offset, uncertain(0.1, 0.2));
        EXPECT_EQ(found.has_value(), inside) << offset.transpose();
    }
}

TEST(LostTracksTest, TheModelsNoiseWidensTheGate) {
    // Acceleration of 1 m/s^2 held for 2 s adds, by B = [2 2]: p 4, pv 4, v 4. S = [4.74 4.32; 4.32 4.2]. A
    // difference of 1.8 m in x alone has 1.8^2 * 4.2 / (4.74 4.2 - 4.32^2) = 10.92 < 13.28.
    TargetModel accelerated = straight;
    accelerated.noise_std = 1;
    for (const TargetModel& model : {straight, accelerated}) {
        LostTracks tracks(0.99, 10);
        tracks.add(lost(1, state(3, 4, 1, 0.5)));
        tracks.predict(2, model);
        EXPECT_EQ(tracks.continuedBy(state(6.8, 5, 1, 0.5), uncertain(0.1, 0.2)).has_value(),
                  model.noise_std > 0);
    }
}

TEST(LostTracksTest, NoiseOfOneDrawAStepSpreadsStepByStep) {
    // 1 m/s^2 for each of 20 steps of 0.1 s. Velocity: sum of 20 draws of 0.1 m/s, 0.2; position: sum over k
    // of (0.1 (0.05 + 0.1 k))^2 for k = 0..19, 0.2665. In one step of 2 s it would be 4 and 4.
    TargetModel stepwise = straight;
    stepwise.noise_std = 1;
    for (const bool near : {true, false}) {
        LostTracks tracks(0.99, 10);
        tracks.add(lost(1, state(0, 0, 0, 0), uncertain(1e-3, 1e-3)));
        for (int k = 0; k < 20; ++k) tracks.predict(0.1, stepwise);
        // Against a new one of the same velocity, known to 1 mm/s: S = [0.2665 0.2; 0.2 0.2] nearly, so a
        // difference of d in x alone has d^2 * 0.2 / 0.0133: 13.28 at 0.940.
        EXPECT_EQ(tracks.continuedBy(state(near ? 0.93 : 0.95, 0, 0, 0), uncertain(1e-3, 1e-3)).has_value(),
                  near);
    }
}

TEST(LostTracksTest, NobodyWhereItCouldBeAnother) {
    LostTracks tracks(0.99, 10);
    tracks.add(lost(1, state(3, 4, 1, 0)));
    tracks.add(lost(2, state(3.4, 4, 1, 0)));
    tracks.predict(1, straight);
    EXPECT_EQ(tracks.continuedBy(state(4.1, 4, 1, 0), uncertain(0.1, 0.1)), std::nullopt);
    // Neither has left: further off only the second fits, and then the first is alone.
    EXPECT_EQ(tracks.continuedBy(state(4, 4, 0.3, 0), uncertain(0.1, 0.1)), std::nullopt);
    EXPECT_EQ(tracks.continuedBy(state(5.6, 4, 1.4, 0), uncertain(0.1, 0.1)), TrackId{2});
    EXPECT_EQ(tracks.continuedBy(state(4.1, 4, 1, 0), uncertain(0.1, 0.1)), TrackId{1});
}

TEST(LostTracksTest, OldOnesAreForgotten) {
    LostTracks tracks(0.99, 5);
    tracks.add(lost(1, state(0, 0, 0, 0)));
    LostTrack later = lost(2, state(50, 0, 0, 0));
    later.at = Stamp::fromSeconds(t0 + 3);
    tracks.add(later);
    tracks.forgetOld(Stamp::fromSeconds(t0 + 5));
    tracks.forgetOld(Stamp::fromSeconds(t0 + 5.1));
    EXPECT_EQ(tracks.continuedBy(state(0, 0, 0, 0), uncertain(0.1, 0.1)), std::nullopt);
    EXPECT_EQ(tracks.continuedBy(state(50, 0, 0, 0), uncertain(0.1, 0.1)), TrackId{2});

    LostTracks exact(0.99, 5);  // kept for 5 s to the tick
    exact.add(lost(1, state(0, 0, 0, 0)));
    exact.forgetOld(Stamp::fromSeconds(t0 + 5));
    EXPECT_EQ(exact.continuedBy(state(0, 0, 0, 0), uncertain(0.1, 0.1)), TrackId{1});
    exact.add(lost(3, state(0, 0, 0, 0)));
    exact.clear();
    EXPECT_EQ(exact.continuedBy(state(0, 0, 0, 0), uncertain(0.1, 0.1)), std::nullopt);
}

}  // namespace lost_tracks_test
}  // namespace slamot

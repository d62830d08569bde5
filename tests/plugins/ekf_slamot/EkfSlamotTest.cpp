#include "conformance/Conformance.h"
#include "support/Expect.h"

namespace slamot {
namespace ekf_slamot_test {

std::shared_ptr<Estimator> ekf(const std::string& consistency) {
    conformance::Options options;
    options.plugin = "ekf_slamot";
    auto estimator = conformance::createSubject(options);
    estimator->initialize(Config::fromText("[ekf_slamot]\nconsistency = " + consistency + "\n"));
    return estimator;
}

/// Landmark 0 straight ahead at `range`, with variances 0.5 m^2 and 0.1 rad^2.
DetectionSet ahead(double range) {
    DetectionSet set;
    auto& seen = std::get<RangeBearingSet>(set.measurements);
    seen.sensors.emplace_back();
    RangeBearingDetection detection;
    detection.range = range;
    detection.covariance = Vector2(0.5, 0.1).asDiagonal();
    detection.kind = ObjectKind::landmark;
    detection.source = SourceId{0};
    seen.detections.push_back(detection);
    return set;
}

TEST(EkfSlamotTest, ClassicFirstSightAndUpdateByHand) {
    const auto estimator = ekf("classic");
    Start start;
    start.pose.covariance = Vector3(1, 1, 0).asDiagonal();
    estimator->start(start);

    // First sight at (2, 0). P_ll = P_RR + diag(0.5, 2^2 * 0.1) = diag(1.5, 1.4), P_Rl = I.
    EXPECT_EQ(estimator->update(ahead(2)).innovations.at(0).outcome, Outcome::initiated);
    LandmarkEstimate landmark = estimator->landmarks().at(0);
    EXPECT_TRUE(test::near(landmark.mean, Vector2(2, 0), 1e-15));
    EXPECT_TRUE(test::near(landmark.covariance, Matrix2(Vector2(1.5, 1.4).asDiagonal()), 1e-15));

    // Again, 0.4 m farther. The relative position has variance diag(0.5, 0.4):
    //   range:   S = 0.5 + 0.5 = 1,         gain on l_x = 0.5,             P_xx = 1.5 - 0.5^2 / 1 = 1.25
    //   bearing: S = 0.4 / 2^2 + 0.1 = 0.2, P h^t on l_y = 0.4 / 2 = 0.2,  P_yy = 1.4 - 0.2^2 / 0.2 = 1.2
    // so the landmark moves by 0.2 m. A robot of known heading learns nothing from a landmark that only it
    // has seen.
    const Innovation innovation = estimator->update(ahead(2.4)).innovations.at(0);
    EXPECT_EQ(innovation.outcome, Outcome::updated);
    EXPECT_TRUE(test::near(innovation.residual, Vector2(0.4, 0), 1e-14));
    EXPECT_NEAR(innovation.nis, 0.16, 1e-14);
    landmark = estimator->landmarks().at(0);
    EXPECT_TRUE(test::near(landmark.mean, Vector2(2.2, 0), 1e-14));
    EXPECT_TRUE(test::near(landmark.covariance, Matrix2(Vector2(1.25, 1.2).asDiagonal()), 1e-14));
    EXPECT_TRUE(test::near(estimator->robot().mean.vector(), Vector3(0, 0, 0), 1e-14));
    EXPECT_TRUE(test::near(estimator->robot().covariance, start.pose.covariance, 1e-14));
}

TEST(EkfSlamotTest, InvariantFirstSightByHand) {
    const auto estimator = ekf("invariant");
    estimator->start({});
    estimator->update(ahead(2));
    // 2 m (1 - 0.1 / 2) = 1.9 m; range variance 0.5 + (2 * 0.1)^2 / 2 = 0.52; across 1.9^2 * 0.1 = 0.361.
    const LandmarkEstimate landmark = estimator->landmarks().at(0);
    EXPECT_TRUE(test::near(landmark.mean, Vector2(1.9, 0), 1e-15));
    EXPECT_TRUE(test::near(landmark.covariance, Matrix2(Vector2(0.52, 0.361).asDiagonal()), 1e-15));

    // The next look: P_lat = 0.361 lowers the innovation by 0.361 / (2 * 1.9) = 0.095 and raises its variance
    // of 0.52 + 0.5 by (0.361 / 1.9)^2 / 2 = 0.19^2 / 2 = 0.01805.
    const Innovation innovation = estimator->update(ahead(2)).innovations.at(0);
    EXPECT_NEAR(innovation.residual.x(), 0.1 - 0.095, 1e-14);
    EXPECT_NEAR(innovation.covariance(0, 0), 1.02 + 0.01805, 1e-14);
}

conformance::Options classic() {
    conformance::Options options;
    options.plugin = "ekf_slamot";
    options.config = "[ekf_slamot]\nconsistency = classic\n";
    options.nees_exemption = "the classic core grows over-confident where bearings are rough";
    return options;
}

}  // namespace ekf_slamot_test
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(ekf_slamot, slamot::conformance::Options{});
SLAMOT_CONFORMANCE_SUITE(ekf_slamot_classic, slamot::ekf_slamot_test::classic());

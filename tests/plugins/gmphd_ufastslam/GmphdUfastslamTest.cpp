#include "conformance/Conformance.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace gmphd_ufastslam_test {

conformance::Options sampled() {
    conformance::Options options;
    options.plugin = "gmphd_ufastslam";
    options.kind = conformance::Kind::sampled;
    options.nees_exemption = "particles die out: what the filter has forgotten it takes for certain";
    return options;
}

/// Landmark 0 straight ahead at `range`, for a sensor of 10 m all round, with deviations 0.1 m and 0.02 rad.
DetectionSet ahead(double range) {
    DetectionSet set = test::detectionsAt(0, {test::seen({}, {range, 0}, ObjectKind::landmark, 0)});
    std::get<RangeBearingSet>(set.measurements).sensors.front().max_range = 10;
    return set;
}

// One particle that stands still. Everything is symmetric about the x axis: means lie on it, covariances are
// diagonal, and sigma points lie at +-s deviations along and across, s = 0.9 sqrt(2), with weights w = 1 / (2
// s^2).
TEST(GmphdUfastslamTest, TwoScansByHand) {
    const double s = 0.9 * std::sqrt(2.0), w = 0.5 / (s * s), centre = 1 - 1 / 0.81 + 1 - 0.81 + 2;
    const auto estimator = conformance::createSubject(sampled());
    estimator->initialize(
        Config::fromText("[gmphd_ufastslam]\nparticles = 1\n[gmphd_ufastslam.map]\nclutter_per_scan = 2\n"
                         "new_per_scan = 6\nlargest_birth = 1\ndetection_probability = 0.8\n"));
    estimator->start({});

    // First sight at 2 m, in Cartesian coordinates; the bearing's points lie 2 (1 - cos(0.02 s)) nearer. It
    // weighs 6 / 8. The log's identity is not used.
    EXPECT_EQ(estimator->update(ahead(2)).innovations.at(0).outcome, Outcome::tentative);
    const double nearer = 2 * (1 - std::cos(0.02 * s)), shift = -2 * w * nearer;
    const double x = 2 + shift;
    const double along =
        centre * shift * shift +
        w * (std::pow(0.1 * s - shift, 2) + std::pow(0.1 * s + shift, 2) + 2 * std::pow(nearer + shift, 2));
    const double across = 2 * w * std::pow(2 * std::sin(0.02 * s), 2);
    LandmarkEstimate landmark = estimator->landmarks().at(0);
    EXPECT_FALSE(landmark.source.valid());
    EXPECT_NEAR(landmark.existence, 0.75, 1e-15);
    EXPECT_TRUE(test::near(landmark.mean, Vector2(x, 0), 1e-14));
    EXPECT_TRUE(test::near(landmark.covariance, Matrix2(Vector2(along, across).asDiagonal()), 1e-14));

    // The detection to come, in polar coordinates: points across are farther away.
    const double a = s * std::sqrt(along), b = s * std::sqrt(across);
    const double farther = std::hypot(x, b) - x, bend = 2 * w * farther;
    const double S_r = centre * bend * bend +
                       w * (std::pow(a - bend, 2) + std::pow(a + bend, 2) + 2 * std::pow(farther - bend, 2)) +
                       0.01;
    const double S_b = 2 * w * std::pow(std::atan2(b, x), 2) + 0.0004;
    const double nu = 2.1 - (x + bend);
    const double q = std::exp(-0.5 * nu * nu / S_r) / (2 * pi * std::sqrt(S_r * S_b));
    const double value = 0.8 * 0.75 * q, detected = value / (2 / (10 * 2 * pi) + value), missed = 0.2 * 0.75;
    // The range is linear along the x axis: its covariance with x is the variance of x.
    const double x_detected = x + along / S_r * nu, along_detected = along - along * along / S_r;

    const UpdateReport report = estimator->update(ahead(2.1));
    EXPECT_EQ(report.innovations.at(0).outcome, Outcome::updated);
    landmark = estimator->landmarks().at(0);
    EXPECT_EQ(landmark.seen, 2);
    EXPECT_EQ(landmark.existence, 1);
    // Detected and not, merged: 0.07 m apart and a deviation of 0.1 m.
    const double weight = detected + missed, d = x_detected - x, part = detected / weight;
    EXPECT_NEAR(landmark.mean.x(), x + part * d, 1e-12);
    EXPECT_NEAR(landmark.covariance(0, 0),
                part * along_detected + (1 - part) * along + part * (1 - part) * d * d, 1e-12);

    // Not detected, it counts for no landmark any more: 0.2 of the weight is left.
    DetectionSet nothing = ahead(2);
    std::get<RangeBearingSet>(nothing.measurements).detections.clear();
    estimator->update(nothing);
    EXPECT_LT(0.2 * weight, 0.5);
    EXPECT_TRUE(estimator->landmarks().empty());
}

}  // namespace gmphd_ufastslam_test
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(gmphd_ufastslam, slamot::gmphd_ufastslam_test::sampled());

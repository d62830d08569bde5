#include "conformance/Conformance.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace pmb_ufastslam_test {

conformance::Options sampled() {
    conformance::Options options;
    options.plugin = "pmb_ufastslam";
    options.kind = conformance::Kind::sampled;
    options.nees_exemption = "particles die out: what the filter has forgotten it takes for certain";
    return options;
}

/// One sensor of 20 m all around and a detection of a landmark without identity.
DetectionSet ahead(double t, double range) {
    DetectionSet set = test::detectionsAt(t, {test::seen({}, {range, 0}, ObjectKind::landmark, -1)});
    RangeBearingSensor& sensor = std::get<RangeBearingSet>(set.measurements).sensors.front();
    sensor.label = "landmarks";
    sensor.kind = ObjectKind::landmark;
    sensor.max_range = 20;
    return set;
}

// One particle at a known pose, one landmark, one detection a scan: the landmark exists more surely with
// every scan and is their mean, as far as the first sight's sigma points and the doubt about what was
// detected let it.
TEST(PmbUfastslamTest, OneLandmarkFromAPoseThatIsKnown) {
    const auto estimator = conformance::createSubject(sampled());
    estimator->initialize(Config::fromText("[pmb_ufastslam]\nparticles = 1\n"));
    estimator->start({});
    for (int k = 0; k < 6; ++k) estimator->update(ahead(0, k % 2 ? 5.05 : 4.95));
    const auto landmarks = estimator->landmarks();
    ASSERT_EQ(landmarks.size(), 1u);
    EXPECT_GT(landmarks[0].existence, 0.99);
    EXPECT_NEAR(landmarks[0].mean.x(), 5, 0.02);
    EXPECT_NEAR(landmarks[0].covariance(0, 0), 0.01 / 6, 0.0005);
    EXPECT_NEAR(landmarks[0].covariance(1, 1), 25 * 0.0004 / 6, 0.0005);
    EXPECT_EQ(landmarks[0].seen, 6);
}

}  // namespace pmb_ufastslam_test
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(pmb_ufastslam, slamot::pmb_ufastslam_test::sampled());

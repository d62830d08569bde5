#include <gtest/gtest.h>

#include <cmath>

#include "Builders.h"
#include "slamot/eval/Nis.h"

namespace slamot::eval {
namespace nis_test {

TEST(Nis, GroupsBySensorAndKindByHand) {
    const double none = std::nan("");
    const auto nis = nisBySensor({innovation(0, "cam", ObjectKind::landmark, Outcome::initiated, none),
                                  innovation(1, "cam", ObjectKind::landmark, Outcome::updated, 1),
                                  innovation(2, "cam", ObjectKind::landmark, Outcome::updated, 2),
                                  innovation(3, "cam", ObjectKind::landmark, Outcome::rejected, 27),
                                  innovation(3, "cam", ObjectKind::mover, Outcome::inflated, 7),
                                  innovation(4, "radar", ObjectKind::mover, Outcome::ignored, none)},
                                 0.95);
    ASSERT_TRUE(nis);
    ASSERT_EQ(nis->size(), 3u);
    const NisGroup& landmarks = (*nis)[0];
    EXPECT_EQ(landmarks.sensor, "cam");
    EXPECT_EQ(landmarks.kind, ObjectKind::landmark);
    EXPECT_EQ(landmarks.outcomes.at(Outcome::updated), 2);
    EXPECT_EQ(landmarks.outcomes.at(Outcome::rejected), 1);
    EXPECT_EQ(landmarks.outcomes.at(Outcome::initiated), 1);
    // Three with a prediction, six degrees of freedom: (1 + 2 + 27) / 6 = 5, median 2 / 2.
    EXPECT_EQ(landmarks.count, 3);
    EXPECT_DOUBLE_EQ(landmarks.mean_per_degree, 5);
    EXPECT_DOUBLE_EQ(landmarks.median_per_degree, 1);
    // Band of two degrees [0.0506, 7.378].
    EXPECT_DOUBLE_EQ(landmarks.inside, 2.0 / 3);
    EXPECT_DOUBLE_EQ(landmarks.coverage, 2.0 / 3);
    // 7 lies inside the band and above the quantile 5.991.
    EXPECT_DOUBLE_EQ((*nis)[1].inside, 1);
    EXPECT_DOUBLE_EQ((*nis)[1].coverage, 0);
    EXPECT_EQ((*nis)[2].count, 0);
    EXPECT_TRUE(std::isnan((*nis)[2].mean_per_degree));
}

TEST(Nis, TentativeDetectionsAreCountedButNotMeasured) {
    // Against something beside the estimate, 27 says nothing of the estimate.
    const auto nis = nisBySensor({innovation(1, "cam", ObjectKind::unknown, Outcome::updated, 3),
                                  innovation(2, "cam", ObjectKind::unknown, Outcome::tentative, 27)},
                                 0.95);
    ASSERT_TRUE(nis);
    ASSERT_EQ(nis->size(), 1u);
    EXPECT_EQ((*nis)[0].outcomes.at(Outcome::tentative), 1);
    EXPECT_EQ((*nis)[0].count, 1);
    EXPECT_DOUBLE_EQ((*nis)[0].mean_per_degree, 1.5);
}

TEST(Nis, AbsentWithoutInnovations) {
    EXPECT_EQ(nisBySensor({}, 0.95).whyAbsent(), "the run has no innovations");
}

}  // namespace nis_test
}  // namespace slamot::eval

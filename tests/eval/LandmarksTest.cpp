#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "Builders.h"
#include "slamot/eval/Landmarks.h"

namespace slamot::eval {
namespace landmarks_test {

Truth threeLandmarks() {
    Truth truth;
    truth.landmarks[SourceId{10}] = {0, 0};
    truth.landmarks[SourceId{11}] = {10, 0};
    truth.landmarks[SourceId{12}] = {20, 0};
    return truth;
}

TEST(Landmarks, BySourceIdByHand) {
    RunRecord run;
    // 10 is off by 5 (3, 4), 11 exact; a second, less seen 11; 99 unknown to truth; one without an id. 12
    // missing.
    run.landmarks = {landmark(0, 10, 3, 4), landmark(1, 11, 10, 0, 8), landmark(2, 11, 10, 9, 3),
                     landmark(3, 99, 0, 0), landmark(4, -1, 0, 0)};
    run.landmarks[0].covariance = 4 * Matrix2::Identity();
    const auto e = landmarkErrors(run, threeLandmarks(), {});
    ASSERT_TRUE(e);
    EXPECT_EQ(e->matching, Matching::source_id);
    EXPECT_EQ(e->matched, 2);
    EXPECT_EQ(e->missing, 1);
    EXPECT_EQ(e->extra, 3);
    EXPECT_DOUBLE_EQ(e->position.rmse, std::sqrt(25.0 / 2));
    // NEES 25 / 4 and 0.
    ASSERT_TRUE(e->nees);
    EXPECT_NEAR(e->nees->average, 25.0 / 8, 1e-12);
}

TEST(Landmarks, WithoutIdsByAssignmentWithinTheCutoff) {
    RunRecord run;
    // The first two lie 1 and 1.5 m from a truth, the third 5 m from the nearest.
    run.landmarks = {landmark(0, -1, 10, 1), landmark(1, -1, 1.5, 0), landmark(2, -1, 25, 0)};
    EvaluationOptions options;
    options.landmark_cutoff = 2;
    const auto e = landmarkErrors(run, threeLandmarks(), options);
    ASSERT_TRUE(e);
    EXPECT_EQ(e->matching, Matching::assignment);
    EXPECT_EQ(e->matched, 2);
    EXPECT_EQ(e->missing, 1);
    EXPECT_EQ(e->extra, 1);
    EXPECT_DOUBLE_EQ(e->position.rmse, std::sqrt((1 + 2.25) / 2));
    options.landmark_cutoff = 6;
    EXPECT_EQ(landmarkErrors(run, threeLandmarks(), options)->matched, 3);
}

TEST(Landmarks, AssignmentOnRequestIgnoresIds) {
    RunRecord run;
    run.landmarks = {landmark(0, 12, 0.5, 0)};
    EvaluationOptions options;
    EXPECT_DOUBLE_EQ(landmarkErrors(run, threeLandmarks(), options)->position.rmse, 19.5);
    options.landmark_matching = Matching::assignment;
    EXPECT_DOUBLE_EQ(landmarkErrors(run, threeLandmarks(), options)->position.rmse, 0.5);
}

TEST(Landmarks, SaysWhatIsMissing) {
    RunRecord run;
    EXPECT_EQ(landmarkErrors(run, threeLandmarks(), {}).whyAbsent(), "the run has no landmarks");
    run.landmarks = {landmark(0, 10, 3, 4)};
    EXPECT_EQ(landmarkErrors(run, {}, {}).whyAbsent(), "truth has no landmarks");
    run.landmarks[0].covariance.setZero();
    EXPECT_THAT(landmarkErrors(run, threeLandmarks(), {})->nees.whyAbsent(), testing::HasSubstr("not known"));
}

}  // namespace landmarks_test
}  // namespace slamot::eval

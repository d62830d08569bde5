// The exact form of the IMM, through JointFilter.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "FullMatrixImm.h"
#include "ImmScenes.h"
#include "slamot/core/filter/JointFilter.h"
#include "support/Expect.h"

namespace slamot {
namespace joint_imm_test {

using test::FullMatrixImm;
using test::immModes;
using test::ImmScene;
using test::near;

using Case = std::tuple<Consistency, ModeLikelihood, std::string>;
class JointImmReference : public testing::TestWithParam<Case> {};

TEST_P(JointImmReference, AgreesWithFullMatricesWhileTargetsComeAndGo) {
    // Both do the same sums in another order; 60 steps of rounding stay far below 1e-9, and any term left out
    // shows above it.
    const auto& [consistency, likelihood, modes] = GetParam();
    JointFilterParameters parameters;
    parameters.consistency = consistency;
    parameters.outliers = OutlierTreatment::accept;
    parameters.target_max_unseen = 0.75;
    parameters.imm = immModes(modes);
    parameters.imm.likelihood = likelihood;
    parameters.imm.stay_probability = 0.8;
    const RobotMotionParameters motion;
    ImmScene scene;
    JointFilter filter(parameters, motion);
    filter.start({}, scene.start());
    FullMatrixImm reference(parameters.imm, consistency, scene.start());

    std::size_t most = 0;
    int ended = 0;
    for (int k = 0; k < 60; ++k) {
        const ImmScene::Step step = scene.next();
        const auto before = filter.tracks();
        filter.predict(step.odometry);
        reference.predict(motion, step.odometry);
        for (const TrackEstimate& track : before) {
            const auto live = filter.tracks();
            if (std::any_of(live.begin(), live.end(),
                            [&](const TrackEstimate& t) { return t.id == track.id; }))
                continue;
            reference.remove(1000 + static_cast<int>(track.source.value));
            ++ended;
        }
        filter.update(step.detections);
        std::vector<std::pair<int, RangeBearingDetection>> known, fresh;
        for (const ObjectKind kind : {ObjectKind::landmark, ObjectKind::mover})
            for (const RangeBearingDetection& d : step.detections.rangeBearing().detections) {
                if (d.kind != kind) continue;
                const int id = static_cast<int>(d.source.value) + (kind == ObjectKind::mover ? 1000 : 0);
                (reference.knows(id) ? known : fresh).push_back({id, d});
            }
        reference.update(known);
        std::reverse(fresh.begin(), fresh.end());  // movers first
        std::stable_sort(fresh.begin(), fresh.end(),
                         [](const auto& a, const auto& b) { return a.first >= 1000 && b.first < 1000; });
        for (const auto& [id, d] : fresh)
            reference.add(id, id >= 1000 ? 6 : 2, d, parameters.target_velocity_std,
                          parameters.target_acceleration_std);

        const FullMatrixImm::Gaussian all = reference.combined();
        const std::string at = "step " + std::to_string(k);
        ASSERT_TRUE(near(filter.robot().mean.vector(), all.x.head<3>(), 1e-9)) << at;
        ASSERT_TRUE(near(filter.robot().covariance, all.P.topLeftCorner<3, 3>(), 1e-9)) << at;
        const auto tracks = filter.tracks();
        most = std::max(most, tracks.size());
        for (std::size_t t = 0; t < tracks.size(); ++t) {
            const int place = reference.offset(1000 + static_cast<int>(tracks[t].source.value));
            ASSERT_TRUE(near(tracks[t].mean, all.x.segment<6>(place), 1e-9)) << at;
            ASSERT_TRUE(near(tracks[t].covariance, all.P.block<6, 6>(place, place), 1e-9)) << at;
            for (std::size_t j = 0; j < parameters.imm.modes.size(); ++j)
                ASSERT_NEAR(tracks[t].mode_probabilities[j],
                            reference.probability(static_cast<int>(t), static_cast<int>(j)), 1e-9)
                    << at;
        }
        for (const LandmarkEstimate& landmark : filter.landmarks()) {
            const int place = reference.offset(static_cast<int>(landmark.source.value));
            ASSERT_TRUE(near(landmark.mean, all.x.segment<2>(place), 1e-9)) << at;
            ASSERT_TRUE(near(landmark.covariance, all.P.block<2, 2>(place, place), 1e-9)) << at;
        }
        ASSERT_NEAR(filter.jointCovariance().matrix.sum(), all.P.sum(), 1e-9 * all.P.cwiseAbs().sum()) << at;
    }
    EXPECT_EQ(most, 2u);
    EXPECT_GE(ended, 3);
}

std::string caseName(const testing::TestParamInfo<Case>& test) {
    const auto& [consistency, likelihood, modes] = test.param;
    return std::string(consistency == Consistency::classic ? "classic" : "invariant") +
           (likelihood == ModeLikelihood::conditional ? "_conditional" : "_marginal") +
           (modes.find("left") == std::string::npos ? "_two" : "_three");
}

INSTANTIATE_TEST_SUITE_P(
    All, JointImmReference,
    testing::Combine(testing::Values(Consistency::classic, Consistency::invariant),
                     testing::Values(ModeLikelihood::conditional, ModeLikelihood::marginal),
                     testing::Values("cv:cv:0.3, ca:ca:2", "cv:cv:0.3, left:ct:0.3:40, ca:ca:2")),
    caseName);

/// A scene played to several filters; compares all they say after each step.
void expectSame(const JointFilterParameters& a, const JointFilterParameters& b, double tolerance) {
    ImmScene scene;
    JointFilter one(a, {}), other(b, {});
    for (JointFilter* filter : {&one, &other}) filter->start({}, scene.start());
    for (int k = 0; k < 60; ++k) {
        const ImmScene::Step step = scene.next();
        for (JointFilter* filter : {&one, &other}) {
            filter->predict(step.odometry);
            filter->update(step.detections);
        }
        ASSERT_TRUE(near(one.robot().mean.vector(), other.robot().mean.vector(), tolerance)) << k;
        ASSERT_TRUE(near(one.jointCovariance().matrix, other.jointCovariance().matrix, tolerance)) << k;
        const auto tracks = one.tracks(), others = other.tracks();
        ASSERT_EQ(tracks.size(), others.size());
        for (std::size_t t = 0; t < tracks.size(); ++t)
            ASSERT_TRUE(near(tracks[t].mean, others[t].mean, tolerance)) << k;
    }
}

class JointImmCores : public testing::TestWithParam<Consistency> {
  protected:
    JointFilterParameters ekf() const {
        JointFilterParameters parameters;
        parameters.consistency = GetParam();
        parameters.target = {TargetModelKind::ca, 1.2, 0.1};
        parameters.target_max_unseen = 0.75;
        return parameters;
    }
    JointFilterParameters imm(const std::string& modes) const {
        JointFilterParameters parameters = ekf();
        parameters.imm = immModes(modes);
        return parameters;
    }
};

TEST_P(JointImmCores, OneModeIsTheEkfToTheBit) {
    expectSame(ekf(), imm("ca:ca:1.2"), 0);
}

TEST_P(JointImmCores, EqualModesAreTheEkf) {
    // Sums of equal halves and quarters round differently, by an ulp a step.
    expectSame(ekf(), imm("a:ca:1.2, b:ca:1.2"), 1e-12);
    expectSame(ekf(), imm("a:ca:1.2, b:ca:1.2, c:ca:1.2"), 1e-12);
}

TEST_P(JointImmCores, TheOrderOfModesChangesNothing) {
    JointFilterParameters plain = imm("cv:cv:0.3, left:ct:0.3:40, ca:ca:2"),
                          turned = imm("ca:ca:2, cv:cv:0.3, left:ct:0.3:40");
    // Not symmetric, so that a transposed matrix shows.
    plain.imm.transition = {{0.8, 0.15, 0.05, 0.3, 0.6, 0.1, 0.2, 0.2, 0.6}};
    turned.imm.transition = {{0.6, 0.2, 0.2, 0.05, 0.8, 0.15, 0.1, 0.3, 0.6}};
    plain.imm.initial = {{0.5, 0.2, 0.3}};
    turned.imm.initial = {{0.3, 0.5, 0.2}};
    ImmScene scene;
    JointFilter one(plain, {}), other(turned, {});
    for (JointFilter* filter : {&one, &other}) filter->start({}, scene.start());
    for (int k = 0; k < 60; ++k) {
        const ImmScene::Step step = scene.next();
        for (JointFilter* filter : {&one, &other}) {
            filter->predict(step.odometry);
            filter->update(step.detections);
        }
        const auto tracks = one.tracks(), others = other.tracks();
        for (std::size_t t = 0; t < tracks.size(); ++t) {
            ASSERT_TRUE(near(tracks[t].mean, others[t].mean, 1e-10)) << k;
            for (int j = 0; j < 3; ++j)
                ASSERT_NEAR(tracks[t].mode_probabilities[j], others[t].mode_probabilities[(j + 1) % 3], 1e-10)
                    << k;
        }
    }
}

TEST_P(JointImmCores, WithoutASightTheChainAloneMovesProbabilities) {
    JointFilterParameters parameters = imm("cv:cv:0.3, ca:ca:2");
    parameters.imm.transition = {{0.9, 0.1, 0.4, 0.6}};
    parameters.imm.transition_interval = 0;
    parameters.imm.initial = {{0.2, 0.8}};
    JointFilter filter(parameters, {});
    filter.start({}, {});
    filter.update(test::detectionsAt(
        0, {test::seen({}, {5, 1}, ObjectKind::mover, 0), test::seen({}, {3, 4}, ObjectKind::landmark, 0)}));
    filter.predict(test::odometry(0, 0.1, {0.1, 0, 0}));
    // mu = c: 0.2 * 0.9 + 0.8 * 0.4 = 0.5; a look at a landmark says nothing of modes.
    filter.update(test::detectionsAt(0.1, {test::seen({0.1, 0, 0}, {3, 4}, ObjectKind::landmark, 0)}));
    EXPECT_NEAR(filter.tracks().at(0).mode_probabilities[0], 0.5, 1e-15);
    filter.predict(test::odometry(0.1, 0.2, {0.1, 0, 0}));
    EXPECT_NEAR(filter.tracks().at(0).mode_probabilities[0], 0.5 * 0.9 + 0.5 * 0.4, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Both, JointImmCores, testing::Values(Consistency::classic, Consistency::invariant),
                         [](const auto& each) {
                             return each.param == Consistency::classic ? "classic" : "invariant";
                         });

TEST(JointImmTest, AManoeuvreIsNoOutlier) {
    // The mover stops at once: far out for cv alone, within reach of ca. Nothing is inflated, ca takes over.
    JointFilterParameters modes, cv;
    modes.imm = immModes("cv:cv:0.05, ca:ca:2000");
    cv.target = {TargetModelKind::cv, 0.05, 0.1};
    JointFilter imm(modes, {}), ekf(cv, {});
    UpdateReport report, report_ekf;
    for (JointFilter* filter : {&imm, &ekf}) filter->start({}, {});
    for (int k = 0; k <= 21; ++k) {
        const DetectionSet set = test::detectionsAt(
            0.1 * k, {test::seen({}, {5 + 0.8 * std::min(k, 19), 1}, ObjectKind::mover, 0)});
        for (JointFilter* filter : {&imm, &ekf}) {
            if (k > 0) filter->predict(test::odometry(0.1 * (k - 1), 0.1 * k, {}));
            (filter == &imm ? report : report_ekf) = filter->update(set);
        }
        if (k == 19) {
            EXPECT_GT(imm.tracks().at(0).mode_probabilities[0], 0.9);
        } else if (k > 19) {
            EXPECT_EQ(report.innovations[0].outcome, Outcome::updated) << k;
            EXPECT_EQ(report_ekf.innovations[0].outcome, Outcome::inflated) << k;
        }
    }
    EXPECT_LT(imm.tracks().at(0).mode_probabilities[0], 0.1);
}

TEST(JointImmTest, FormsByTheNumberOfMovers) {
    const auto movers = [](int first, int last) {
        std::vector<RangeBearingDetection> seen;
        for (int i = first; i < last; ++i) seen.push_back(test::seen({}, {5, 2.0 * i}, ObjectKind::mover, i));
        return seen;
    };
    JointFilterParameters parameters;
    parameters.imm = immModes("cv:cv:0.3, ca:ca:2");
    parameters.target_max_unseen = 1;
    JointFilter filter(parameters, {});
    filter.start({}, {});
    filter.update(test::detectionsAt(0, movers(0, 2)));
    EXPECT_EQ(filter.state().modeCount(), 4);
    filter.update(test::detectionsAt(0, movers(2, 4)));
    EXPECT_EQ(filter.state().modeCount(), 1);
    EXPECT_EQ(filter.tracks().size(), 4u);
    filter.predict(test::odometry(0, 2, {}));
    EXPECT_TRUE(filter.tracks().empty());
    filter.update(test::detectionsAt(2, movers(0, 1)));
    EXPECT_EQ(filter.state().modeCount(), 2) << "exact again after the last track";

    parameters.imm.form = ImmForm::exact;
    JointFilter exact(parameters, {});
    exact.start({}, {});
    const UpdateReport report = exact.update(test::detectionsAt(0, movers(0, 3)));
    EXPECT_EQ(report.innovations[2].outcome, Outcome::ignored);
    EXPECT_EQ(exact.tracks().size(), 2u);

    parameters.imm.form = ImmForm::scalable;
    JointFilter scalable(parameters, {});
    scalable.start({}, {});
    scalable.update(test::detectionsAt(0, movers(0, 1)));
    EXPECT_EQ(scalable.state().modeCount(), 1);
    EXPECT_EQ(scalable.tracks().at(0).mode_probabilities, (std::vector<double>{0.5, 0.5}));
}

}  // namespace joint_imm_test
}  // namespace slamot

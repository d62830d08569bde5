// The laws themselves: an honest estimator keeps them all, and each flaw breaks the law that is there to find
// it.
#include <gmock/gmock.h>
#include <slamot/core/models/RobotMotion.h>
#include <slamot/core/random/RandomStream.h>

#include <cmath>

#include "conformance/Conformance.h"
#include "conformance/Laws.h"

namespace slamot::conformance {

enum class Flaw {
    none,
    depends_on_threads,
    survives_reset,
    asymmetric,
    indefinite,
    empty_set_throws,
    empty_set_moves,
    wrong_landmark_count,
    particles_elsewhere,
    surer_than_sure,
    unprintable_parameter,
    foreign_section,
    ignores_unknown_keys,
    tied_to_the_world,
    unwrapped_residual,
    drifts,
    over_confident,
    too_humble
};

/// Dead reckoning, with one thing wrong. With `sampling` above 0 it also shakes its pose by that part of the
/// odometry's noise, and says so in its covariance.
class Suspect : public Estimator {
    DEFINE_MRPT_OBJECT(Suspect, slamot::conformance)

  public:
    Suspect() = default;
    Suspect(Flaw flaw, double sampling) : flaw_(flaw), sampling_(sampling) {}
    std::string name() const override { return "suspect"; }

  protected:
    std::vector<ParameterTable> onParameters() override {
        ParameterTable own(flaw_ == Flaw::foreign_section ? "ekf_slamot" : "suspect", "A test.");
        own.real("scale", scale_, "-", Interval::positive(), "Factor on the variance.");
        if (flaw_ == Flaw::unprintable_parameter)
            own.custom({"odd", "-", "a number", "Prints what it does not parse.",
                        [](const std::string& text) -> std::optional<std::string> {
                            if (numberFromText(text)) return std::nullopt;
                            return "a number";
                        },
                        [] { return std::string("1 metre"); }});
        if (flaw_ == Flaw::ignores_unknown_keys)
            own.custom({"no_such_key", "-", "text", "Takes all.",
                        [](const std::string&) -> std::optional<std::string> { return std::nullopt; },
                        [] { return std::string(); }});
        return {describe(motion_), own};
    }
    void onStart(const Start& start) override {
        pose_ = start.pose;
        start_ = start;
        if (flaw_ != Flaw::survives_reset) step_ = 0;
    }
    void onPredict(const OdometryIncrement& odometry) override {
        const MotionPrediction moved = predictMotion(motion_, pose_.mean.vector(), odometry);
        const Matrix3 Q = moved.Q * (flaw_ == Flaw::over_confident ? 0.25
                                     : flaw_ == Flaw::too_humble   ? 4.0
                                                                   : scale_);
        Vector3 mean = moved.pose;
        ++step_;
        if (sampling_ > 0) {
            RandomStream random(start_.seed, RandomPurpose::test, 0, step_);
            const Vector3 local(0.1 * sampling_ * random.normal(), 0, 0.01 * sampling_ * random.normal());
            mean += Vector3(local.x() * std::cos(mean.z()), local.x() * std::sin(mean.z()), local.z());
        }
        if (flaw_ == Flaw::depends_on_threads) mean.x() += 1e-12 * start_.threads;
        if (flaw_ == Flaw::survives_reset) mean.x() += 1e-12 * step_;
        if (flaw_ == Flaw::tied_to_the_world) mean.x() += sampling_ > 0 ? 0.05 : 1e-8;
        if (flaw_ == Flaw::drifts) mean.head<2>() += 2e-3 * Vector2(std::cos(mean.z()), std::sin(mean.z()));
        pose_.mean = Pose2::fromVector(mean);
        pose_.covariance = moved.F * pose_.covariance * moved.F.transpose() + Q;
        if (flaw_ == Flaw::asymmetric) pose_.covariance(0, 1) += 1e-6;
        if (flaw_ == Flaw::indefinite) pose_.covariance(2, 2) = -1e-6;
    }
    UpdateReport onUpdate(const DetectionSet& set) override {
        UpdateReport report;
        const auto& detections = set.rangeBearing().detections;
        if (detections.empty() && flaw_ == Flaw::empty_set_throws) throw EstimatorError("nothing seen");
        if (detections.empty() && flaw_ == Flaw::empty_set_moves) pose_.mean.y += 1e-9;
        for (std::size_t i = 0; i < detections.size(); ++i) {
            report.innovations.emplace_back();
            report.innovations.back().detection = static_cast<int>(i);
            if (flaw_ == Flaw::unwrapped_residual) {
                report.innovations.back().nis = 1;
                report.innovations.back().residual = {0, detections[i].bearing < 0 ? 2 * pi : 0.0};
            }
        }
        return report;
    }
    PoseGaussian onRobot() const override { return pose_; }
    std::vector<LandmarkEstimate> onTentative() const override {
        LandmarkEstimate candidate;
        candidate.existence = flaw_ == Flaw::surer_than_sure ? 1.1 : 0.5;
        return {candidate};
    }
    std::vector<ParticleEstimate> onParticles() const override {
        ParticleEstimate all{1, pose_};
        if (flaw_ == Flaw::particles_elsewhere) all.pose.mean.x += 1e-6;
        return {all};
    }
    std::int64_t onLandmarkCount() const override { return flaw_ == Flaw::wrong_landmark_count ? 1 : 0; }

  private:
    Flaw flaw_ = Flaw::none;
    double sampling_ = 0, scale_ = 1;
    RobotMotionParameters motion_;
    PoseGaussian pose_;
    Start start_;
    std::uint32_t step_ = 0;
};

}  // namespace slamot::conformance

IMPLEMENTS_MRPT_OBJECT(Suspect, slamot::Estimator, slamot::conformance)

namespace slamot::conformance {
namespace laws_test {

Options suspect(Flaw flaw, double sampling = 0) {
    Options options;
    options.plugin = "suspect";
    options.kind = sampling > 0 ? Kind::sampled : Kind::deterministic;
    options.create = [=] { return std::make_shared<Suspect>(flaw, sampling); };
    return options;
}

Options shaken() {
    Options options = suspect(Flaw::none, 0.1);
    // Shaking adds (0.01 m)^2 and (0.001 rad)^2 a step to odometry noise of (0.01 m)^2 and (0.0035 rad)^2 a
    // step, which the covariance does not count.
    options.nees_exemption = "shaken more than it says";
    return options;
}

TEST(LawsTest, EachFlawBreaksItsLaw) {
    EXPECT_NE(sameBitsForAnyThreads(suspect(Flaw::depends_on_threads)), "");
    EXPECT_NE(resetEqualsNew(suspect(Flaw::survives_reset)), "");
    EXPECT_NE(covariancesStayDefinite(suspect(Flaw::asymmetric)), "");
    EXPECT_NE(covariancesStayDefinite(suspect(Flaw::indefinite)), "");
    EXPECT_NE(emptySetIsAccepted(suspect(Flaw::empty_set_throws)), "");
    EXPECT_NE(emptySetIsAccepted(suspect(Flaw::empty_set_moves)), "");
    EXPECT_NE(queriesAgree(suspect(Flaw::wrong_landmark_count)), "");
    EXPECT_NE(queriesAgree(suspect(Flaw::particles_elsewhere)), "");
    EXPECT_NE(queriesAgree(suspect(Flaw::surer_than_sure)), "");
    EXPECT_NE(parametersRoundTrip(suspect(Flaw::unprintable_parameter)), "");
    EXPECT_NE(parametersRoundTrip(suspect(Flaw::foreign_section)), "");
    EXPECT_NE(unknownKeyIsRefused(suspect(Flaw::ignores_unknown_keys)), "");
    EXPECT_NE(worldMayBeMoved(suspect(Flaw::tied_to_the_world)), "");
    EXPECT_NE(bearingsAcrossPi(suspect(Flaw::unwrapped_residual)), "");
    EXPECT_NE(noiseFreeConverges(suspect(Flaw::drifts)),
              "");  // 200 steps of 2 mm on 5 rad of a circle: 2 (0.4 m / 5) sin(2.5) = 0.096 m
    EXPECT_NE(neesInBand(suspect(Flaw::over_confident)), "");
    EXPECT_NE(neesInBand(suspect(Flaw::too_humble)), "");
}

TEST(LawsTest, SampledLawsSeeThroughTheNoise) {
    EXPECT_NE(worldMayBeMoved(suspect(Flaw::tied_to_the_world, 0.1)), "");
    EXPECT_NE(noiseFreeConverges(suspect(Flaw::tied_to_the_world, 0.1)), "");
}

TEST(LawsTest, VerdictsAreSentences) {
    EXPECT_THAT(covariancesStayDefinite(suspect(Flaw::asymmetric)),
                testing::HasSubstr("the robot's covariance is not symmetric"));
    EXPECT_THAT(emptySetIsAccepted(suspect(Flaw::empty_set_throws)), testing::HasSubstr("nothing seen"));
}

TEST(LawsTest, SampledLawsHoldForAnHonestSampler) {
    EXPECT_EQ(worldMayBeMoved(shaken()), "");
    EXPECT_EQ(noiseFreeConverges(shaken()), "");
    EXPECT_EQ(sameBitsForAnyThreads(shaken()), "");
    EXPECT_EQ(resetEqualsNew(shaken()), "");
}

}  // namespace laws_test
}  // namespace slamot::conformance

SLAMOT_CONFORMANCE_SUITE(honest, slamot::conformance::laws_test::suspect(slamot::conformance::Flaw::none));

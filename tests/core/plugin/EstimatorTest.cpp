#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "slamot/core/plugin/Estimator.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {

/// Adds increments up, counts calls, and breaks on request.
class FrontTestEstimator : public Estimator {
    DEFINE_MRPT_OBJECT(FrontTestEstimator, slamot)

  public:
    std::string name() const override { return "front_test"; }

    double gain = 1;
    int starts = 0, predictions = 0, updates = 0;
    PoseGaussian pose;
    std::vector<TrackEstimate> track_list;
    std::vector<ParticleEstimate> particle_list;
    bool update_fails = false;
    int report_offset = 0;

  protected:
    std::vector<ParameterTable> onParameters() override {
        ParameterTable table("front_test", "For the tests of Estimator.");
        table.real("gain", gain, "-", Interval::positive(), "A parameter.");
        return {table};
    }
    void onInitialize(const Config&) override {
        if (gain > 100) throw ConfigError("front_test: gain above 100 makes no sense");
    }
    void onStart(const Start& start) override {
        ++starts;
        pose = start.pose;
        track_list.clear();
    }
    void onPredict(const OdometryIncrement& odometry) override {
        ++predictions;
        pose.mean = pose.mean * odometry.increment;
    }
    UpdateReport onUpdate(const DetectionSet& set) override {
        ++updates;
        if (update_fails) throw std::domain_error("innovation covariance S is not positive definite");
        constexpr Outcome all[] = {Outcome::updated, Outcome::inflated, Outcome::rejected, Outcome::initiated,
                                   Outcome::ignored};
        UpdateReport report;
        for (std::size_t i = 0; i < set.rangeBearing().detections.size(); ++i) {
            Innovation innovation;
            innovation.detection = static_cast<int>(i) + report_offset;
            innovation.outcome = all[i % 5];
            if (!track_list.empty()) innovation.track = track_list.back().id;
            report.innovations.push_back(innovation);
        }
        return report;
    }
    PoseGaussian onRobot() const override { return pose; }
    std::vector<TrackEstimate> onTracks() const override { return track_list; }
    std::vector<ParticleEstimate> onParticles() const override { return particle_list; }
    std::vector<LandmarkEstimate> onLandmarks() const override {
        std::vector<LandmarkEstimate> out(3);
        for (int i = 0; i < 3; ++i) out[i].id = {i};
        return out;
    }
};

}  // namespace slamot

IMPLEMENTS_MRPT_OBJECT(FrontTestEstimator, Estimator, slamot)

namespace slamot {
namespace estimator_test {

using test::detectionsAt;
using test::messageOf;
using test::near;
using test::odometry;
using test::seen;
using testing::HasSubstr;
using testing::StartsWith;

class EstimatorTest : public testing::Test {
  protected:
    EstimatorTest() {
        estimator_.initialize({});
        Start start;
        start.stamp = Stamp::fromSeconds(10);
        start.pose = {{1, 2, 0.5}, 0.01 * Matrix3::Identity()};
        estimator_.start(start);
    }
    std::string refusedPrediction(const OdometryIncrement& entry) {
        const std::string message = messageOf<EstimatorError>([&] { estimator_.predict(entry); });
        EXPECT_THAT(message, StartsWith("front_test: "));
        return message;
    }
    std::string refusedUpdate(const RangeBearingDetection& detection) {
        const int before = estimator_.updates;
        const std::string message = messageOf<EstimatorError>([&] {
            estimator_.update(detectionsAt(10, {good(), detection}));
        });
        EXPECT_EQ(estimator_.updates, before) << "the plugin must not see it";
        EXPECT_THAT(message, StartsWith("front_test: detection 1 at 10.0000000 "));
        return message;
    }
    static RangeBearingDetection good() { return seen({}, {3, 4}, ObjectKind::landmark, 1); }

    FrontTestEstimator estimator_;
};

TEST(EstimatorLifeTest, MustBeInitializedThenStarted) {
    FrontTestEstimator estimator;
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator.start({}); }),
                HasSubstr("front_test: start before initialize"));
    estimator.initialize({});
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator.predict({}); }), HasSubstr("predict before start"));
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator.update({}); }), HasSubstr("update before start"));
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator.estimate(); }), HasSubstr("estimate before start"));
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator.reset(); }), HasSubstr("reset before start"));
    estimator.start({});
    EXPECT_NO_THROW(estimator.estimate());
    estimator.initialize({});  // begins a new life
    EXPECT_THROW(estimator.predict({}), EstimatorError);
}

TEST(EstimatorLifeTest, ReadsItsParameters) {
    FrontTestEstimator estimator;
    estimator.initialize(Config::fromText("[front_test]\ngain = 3\n"));
    EXPECT_EQ(estimator.gain, 3);
    EXPECT_EQ(estimator.parameterTables().at(0).find("gain")->print(), "3");
    EXPECT_THROW(estimator.initialize(Config::fromText("[front_test]\ngaim = 3\n")), ConfigError);
    EXPECT_THROW(estimator.initialize(Config::fromText("[front_test]\ngain = 200\n")), ConfigError);
}

TEST(EstimatorLifeTest, RefusesABadStart) {
    FrontTestEstimator estimator;
    estimator.initialize({});
    Start bad_mean, bad_covariance;
    bad_mean.pose.mean.x = std::numeric_limits<double>::quiet_NaN();
    bad_covariance.pose.covariance(0, 0) = -1;
    for (const Start& start : {bad_mean, bad_covariance}) {
        EXPECT_THROW(estimator.start(start), EstimatorError);
        EXPECT_EQ(estimator.starts, 0);
    }
}

TEST_F(EstimatorTest, StepsForward) {
    estimator_.predict(odometry(10, 10.5, {1, 0, 0}));
    EXPECT_EQ(estimator_.time(), Stamp::fromSeconds(10.5));
    estimator_.predict(odometry(10.5, 10.5, {}));  // no time at all is legal
    const Estimate estimate = estimator_.estimate();
    EXPECT_EQ(estimate.stamp, Stamp::fromSeconds(10.5));
    EXPECT_NEAR(estimate.robot.mean.x, 1 + std::cos(0.5), 1e-15);
    EXPECT_EQ(estimate.health.predictions, 2);
}

TEST_F(EstimatorTest, RefusesTimeGoingBackAndGaps) {
    EXPECT_THROW(estimator_.predict(odometry(9.9, 10.1, {})), TimeOrderError);
    EXPECT_THROW(estimator_.predict(odometry(10, 9.9, {})), TimeOrderError);
    EXPECT_THROW(estimator_.predict(odometry(10.1, 10.2, {})), TimeOrderError);
    EXPECT_THROW(estimator_.update(detectionsAt(10.0000001, {})), TimeOrderError);
    EXPECT_THROW(estimator_.update(detectionsAt(9.9999999, {})), TimeOrderError);
    EXPECT_THAT(refusedPrediction(odometry(9, 11, {})),
                HasSubstr("odometry over (9.0000000, 11.0000000] cannot follow time 10.0000000"));
    EXPECT_THAT(refusedPrediction(odometry(11, 12, {})),
                HasSubstr("odometry starts at 11.0000000, after the present time 10.0000000: a gap"));
    EXPECT_EQ(estimator_.predictions, 0);
    EXPECT_EQ(estimator_.updates, 0);
    EXPECT_EQ(estimator_.time(), Stamp::fromSeconds(10));
}

TEST_F(EstimatorTest, RefusesOdometryThatIsNotFinite) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        for (const Pose2& increment : {Pose2{bad, 0, 0}, Pose2{0, bad, 0}, Pose2{0, 0, bad}})
            EXPECT_THAT(refusedPrediction(odometry(10, 11, increment)),
                        HasSubstr("odometry at 11.0000000 is not finite"));
        for (const BodyVelocity& velocity :
             {BodyVelocity{bad, 0, 0}, BodyVelocity{0, bad, 0}, BodyVelocity{0, 0, bad}}) {
            OdometryIncrement entry = odometry(10, 11, {});
            entry.velocity = velocity;
            EXPECT_THAT(refusedPrediction(entry), HasSubstr("not finite"));
        }
    }
    OdometryIncrement entry = odometry(10, 11, {});
    entry.covariance = Vector3(1, 1, -0.1).asDiagonal();
    EXPECT_THAT(refusedPrediction(entry), HasSubstr("covariance that is not positive semi-definite"));
    EXPECT_EQ(estimator_.predictions, 0);
    entry.covariance = Vector3(1, 0, 0).asDiagonal();  // exactly known components are legal
    EXPECT_NO_THROW(estimator_.predict(entry));
}

TEST_F(EstimatorTest, RefusesBadDetectionsBeforeThePluginSeesThem) {
    const auto changed = [](auto change) {
        RangeBearingDetection detection = good();
        change(detection);
        return detection;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusedUpdate(changed([&](auto& d) { d.range = nan; })), HasSubstr("is not finite"));
    EXPECT_THAT(refusedUpdate(changed([&](auto& d) { d.bearing = 1 / 0.0; })), HasSubstr("is not finite"));
    EXPECT_THAT(refusedUpdate(changed([](auto& d) { d.range = 0; })),
                HasSubstr("range that is not positive"));
    EXPECT_THAT(refusedUpdate(changed([](auto& d) { d.range = -1; })),
                HasSubstr("range that is not positive"));
    EXPECT_THAT(refusedUpdate(changed([](auto& d) { d.covariance(1, 1) = 0; })),
                HasSubstr("not positive definite"));
    EXPECT_THAT(refusedUpdate(changed([&](auto& d) { d.covariance(0, 0) = nan; })),
                HasSubstr("not positive definite"));
    EXPECT_THAT(refusedUpdate(changed([](auto& d) { d.covariance << 1, 2, 2, 1; })),
                HasSubstr("not positive definite"));
    EXPECT_THAT(refusedUpdate(changed([](auto& d) { d.sensor = 1; })),
                HasSubstr("names no sensor of its set"));
    EXPECT_THAT(refusedUpdate(changed([](auto& d) { d.sensor = -1; })),
                HasSubstr("names no sensor of its set"));
    EXPECT_EQ(estimator_.estimate().health.updates, 0);
}

TEST_F(EstimatorTest, CountsWhatBecameOfDetections) {
    estimator_.update(detectionsAt(10, std::vector<RangeBearingDetection>(7, good())));
    estimator_.update(detectionsAt(10, {}));
    // updated, inflated, rejected, initiated, ignored, updated, inflated
    const Health health = estimator_.estimate().health;
    EXPECT_EQ(health.updates, 2);
    EXPECT_EQ(health.detections_used, 3);
    EXPECT_EQ(health.detections_inflated, 2);
    EXPECT_EQ(health.detections_rejected, 1);
    EXPECT_EQ(health.detections_ignored, 1);
}

TEST_F(EstimatorTest, NoticesAStateThatWentBad) {
    estimator_.pose.covariance = Vector3(1, 1, -1e-8).asDiagonal();
    EXPECT_THAT(
        messageOf<EstimatorError>([&] { estimator_.update(detectionsAt(10, {})); }),
        HasSubstr(
            "front_test: after update at 10.0000000 the robot's pose is not finite or its covariance [x y "
            "theta] not positive semi-definite"));
    estimator_.pose.covariance = Vector3(1, 1, -1e-10).asDiagonal();  // rounding
    EXPECT_NO_THROW(estimator_.update(detectionsAt(10, {})));
    estimator_.pose.mean.y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusedPrediction(odometry(10, 11, {})), HasSubstr("after predict at 11.0000000"));
    estimator_.reset();
    estimator_.track_list.resize(2);
    estimator_.track_list[1].id = {42};
    estimator_.track_list[1].covariance(5, 5) = -1;
    EXPECT_NO_THROW(estimator_.update(detectionsAt(10, {})));  // only what an update touched is looked at
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator_.update(detectionsAt(10, {good()})); }),
                HasSubstr("track 42"));
}

TEST_F(EstimatorTest, ParticlesMustBeAWhole) {
    EXPECT_TRUE(estimator_.particles().empty());
    estimator_.particle_list = {{0.25, {}}, {0.75, {}}};
    EXPECT_EQ(estimator_.particles().size(), 2u);
    estimator_.particle_list[1].weight = 0.8;
    EXPECT_EQ(messageOf<EstimatorError>([&] { estimator_.particles(); }),
              "front_test: the weights of 2 particles at 10.0000000 sum to 1.05 instead of 1");
    estimator_.particle_list = {{1.25, {}}, {-0.25, {}}};
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator_.particles(); }),
                HasSubstr("particle 1 at 10.0000000"));
    estimator_.particle_list = {{1, {}}};
    estimator_.particle_list[0].pose.mean.x = std::numeric_limits<double>::infinity();
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator_.particles(); }), HasSubstr("particle 0"));
}

TEST_F(EstimatorTest, NoticesAReportThatCannotBe) {
    estimator_.report_offset = 1;
    EXPECT_THAT(messageOf<EstimatorError>([&] { estimator_.update(detectionsAt(10, {good()})); }),
                HasSubstr("its report names detection 1 of 1"));
}

TEST_F(EstimatorTest, NumericalFailuresNameEstimatorAndTime) {
    estimator_.update_fails = true;
    EXPECT_EQ(messageOf<EstimatorError>([&] { estimator_.update(detectionsAt(10, {})); }),
              "front_test: update at 10.0000000: innovation covariance S is not positive definite");
}

TEST_F(EstimatorTest, ResetEqualsAFreshStart) {
    const Estimate fresh = estimator_.estimate();
    estimator_.predict(odometry(10, 11, {1, 2, 3}));
    estimator_.update(detectionsAt(11, {good()}));
    estimator_.reset();
    const Estimate again = estimator_.estimate();
    EXPECT_EQ(again.stamp, fresh.stamp);
    EXPECT_TRUE(near(again.robot.mean.vector(), fresh.robot.mean.vector(), 0));
    EXPECT_TRUE(near(again.robot.covariance, fresh.robot.covariance, 0));
    EXPECT_EQ(again.health.predictions, 0);
    EXPECT_EQ(again.health.updates, 0);
    EXPECT_EQ(again.health.detections_used, 0);
    EXPECT_NO_THROW(estimator_.predict(odometry(10, 11, {1, 2, 3})));
}

TEST_F(EstimatorTest, LandmarksByIdComeInTheOrderAskedFor) {
    const auto some = estimator_.landmarks({{2}, {7}, {0}});
    ASSERT_EQ(some.size(), 2u);
    EXPECT_EQ(some[0].id.value, 2);
    EXPECT_EQ(some[1].id.value, 0);
}

TEST_F(EstimatorTest, IsAnMrptObject) {
    EXPECT_STREQ(estimator_.GetRuntimeClass()->className, "slamot::FrontTestEstimator");
    EXPECT_TRUE(estimator_.GetRuntimeClass()->derivedFrom(CLASS_ID_NAMESPACE(Estimator, slamot)));
}

}  // namespace estimator_test
}  // namespace slamot

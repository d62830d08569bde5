// False detections added and true ones withheld.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "run/Spy.h"
#include "support/Expect.h"

namespace slamot::test {
namespace clutter_test {

using run::SensorRole;
using testing::HasSubstr;

class ClutterTest : public PipelineTest {
  protected:
    /// What the estimator got, and what the sinks were told of it.
    std::vector<run::Step> stepsOf(const std::vector<mrpt::obs::CObservation::Ptr>& log) {
        pipeline.reset();
        spy = std::make_shared<Spy>();
        sink = {};
        process(log);
        std::vector<run::Step> steps;
        for (const run::Step& step : sink.steps)
            if (step.has_detections) steps.push_back(step);
        return steps;
    }
    static std::vector<Vector2> measurements(const std::vector<run::Step>& steps) {
        std::vector<Vector2> all;
        for (const run::Step& step : steps)
            for (const RangeBearingDetection& d : detectionsOf(step.detections)) all.push_back(d.z());
        return all;
    }
    /// Of the detections that the log does not have.
    static std::vector<Vector2> falseOnes(const std::vector<run::Step>& steps) {
        std::vector<Vector2> all;
        for (const run::Step& step : steps)
            for (std::size_t i = 0; i < step.log_numbers.size(); ++i)
                if (step.log_numbers[i] < 0) all.push_back(detectionsOf(step.detections)[i].z());
        return all;
    }
    /// Looks every second; `ranges` holds what it sees each time, at bearings 0.1, 0, -0.1, ...
    static std::vector<mrpt::obs::CObservation::Ptr> looking(int times, const std::vector<double>& ranges,
                                                             const std::string& label = "landmarks") {
        std::vector<mrpt::obs::CObservation::Ptr> log{odometry(0, {})};
        std::vector<Seen> seen;
        for (const double range : ranges)
            seen.push_back({range, 0.1 - 0.1 * static_cast<double>(seen.size()),
                            static_cast<std::int64_t>(seen.size())});
        for (int k = 1; k <= times; ++k) {
            log.push_back(odometry(k, {}));
            log.push_back(detections(k, label, seen));
        }
        log.push_back(odometry(times + 1, {}));
        return log;
    }
};

TEST_F(ClutterTest, NothingIsDoneUnlessAsked) {
    const auto steps = stepsOf(looking(3, {4, 5}));
    ASSERT_EQ(steps.size(), 3u);
    for (const run::Step& step : steps) {
        EXPECT_EQ(step.log_numbers, (std::vector<int>{0, 1}));
        EXPECT_EQ(step.log_count, 2);
        EXPECT_EQ(detectionsOf(step.detections)[0].range, 4) << "the order of the log";
    }
    EXPECT_EQ(pipeline->counts().clutter.added, 0);
    EXPECT_EQ(pipeline->counts().clutter.withheld, 0);
}

TEST_F(ClutterTest, FalseDetectionsLieAnywhereInViewAndTellNothing) {
    config.clutter.per_scan = 3;
    config.sensors.by_label["camera"] = SensorRole::mixed;
    std::vector<mrpt::obs::CObservation::Ptr> log{odometry(0, {})};
    const int scans = 1000;
    for (int k = 1; k <= scans; ++k) {
        auto seen =
            std::dynamic_pointer_cast<mrpt::obs::CObservationBearingRange>(detections(k, "camera", {}));
        seen->minSensorDistance = 5;
        seen->maxSensorDistance = 20;
        seen->fieldOfView_yaw = 1.5f;
        log.push_back(odometry(k, {}));
        log.push_back(seen);
    }
    const auto steps = stepsOf(log);
    double range = 0, bearing = 0;
    std::set<std::size_t> counts;
    for (const run::Step& step : steps) {
        counts.insert(detectionsOf(step.detections).size());
        for (const RangeBearingDetection& d : detectionsOf(step.detections)) {
            EXPECT_TRUE(d.range >= 5 && d.range <= 20) << d.range;
            EXPECT_LE(std::abs(d.bearing), 0.75);
            EXPECT_EQ(d.kind, ObjectKind::unknown);
            EXPECT_FALSE(d.source.valid());
            EXPECT_EQ(d.sensor, 0);
            // Nothing else was seen: what the sensor claims.
            EXPECT_TRUE(near(d.covariance, Matrix2(Vector2(0.25, 0.015625).asDiagonal()), 0));
            range += d.range;
            bearing += d.bearing;
        }
    }
    const auto total = static_cast<double>(pipeline->counts().clutter.added);
    EXPECT_EQ(falseOnes(steps).size(), pipeline->counts().clutter.added);
    EXPECT_EQ(pipeline->counts().detections, pipeline->counts().clutter.added);
    // Poisson: variance = mean; uniform over w: variance w^2 / 12. Four standard deviations.
    EXPECT_NEAR(total, 3 * scans, 4 * std::sqrt(3.0 * scans));
    EXPECT_NEAR(range / total, 12.5, 4 * 15 / std::sqrt(12 * total));
    EXPECT_NEAR(bearing / total, 0, 4 * 1.5 / std::sqrt(12 * total));
    EXPECT_EQ(counts.count(0), 1u);  // e^-3 of 1000 scans have none
    EXPECT_EQ(counts.count(3), 1u);
}

TEST_F(ClutterTest, DetectionsAreKeptWithTheirProbability) {
    config.clutter.detection_probability = 0.75;
    const auto steps = stepsOf(looking(1000, {4, 5, 6}));
    std::vector<int> kept(3, 0);
    int together = 0;
    for (const run::Step& step : steps) {
        for (const int number : step.log_numbers) ++kept.at(static_cast<std::size_t>(number));
        together += step.log_numbers.size() == 3;
        EXPECT_EQ(step.log_count, 3);
    }
    // Binomial, four standard deviations: sqrt(1000 * 0.75 * 0.25) = 13.7; each for itself: 0.75^3 = 0.42
    // have all, sqrt(1000 * 0.42 * 0.58) = 15.6.
    for (const int count : kept) EXPECT_NEAR(count, 750, 55);
    EXPECT_NEAR(together, 421.9, 62.5);
    EXPECT_EQ(pipeline->counts().clutter.withheld, 3000 - kept[0] - kept[1] - kept[2]);
    EXPECT_EQ(pipeline->counts().clutter.added, 0);

    config.clutter.detection_probability = 0;
    const auto none = stepsOf(looking(5, {4}));
    EXPECT_EQ(none.size(), 5u) << "the sensor looked";
    EXPECT_TRUE(measurements(none).empty());
}

TEST_F(ClutterTest, NumbersAreThoseOfTheLogWhateverWasDoneToIt) {
    config.clutter.per_scan = 2;
    config.clutter.detection_probability = 0.6;
    config.sensors.by_label["camera"] = SensorRole::ignore;
    // Ten metres and its number each; number 4 is no number.
    std::vector<mrpt::obs::CObservation::Ptr> log{odometry(0, {})};
    for (int k = 1; k <= 200; ++k) {
        log.push_back(odometry(k, {}));
        log.push_back(detections(k, "camera", {{10, 0}, {11, 0}}));
        log.push_back(detections(k, "landmarks", {{12, 0.3}, {13, -0.3}, {std::nan(""), 0}, {15, 2}}));
        log.push_back(detections(k, "movers", {{16, 1}, {17, 0.5}}));
    }
    const auto steps = stepsOf(log);
    ASSERT_EQ(steps.size(), 200u);
    std::set<int> met;
    int added = 0;
    for (const run::Step& step : steps) {
        const auto& all = detectionsOf(step.detections);
        ASSERT_EQ(step.log_numbers.size(), all.size());
        EXPECT_EQ(step.log_count, 8);
        for (std::size_t i = 0; i < all.size(); ++i) {
            met.insert(step.log_numbers[i]);
            if (step.log_numbers[i] >= 0) {
                EXPECT_EQ(all[i].range, 10 + step.log_numbers[i]);
            } else {
                ++added;
                EXPECT_NE(all[i].range, std::round(all[i].range));
            }
            // The order tells nothing: by bearing, sensor by sensor.
            if (i > 0 && all[i].sensor == all[i - 1].sensor) {
                EXPECT_GE(all[i].bearing, all[i - 1].bearing);
            }
        }
    }
    EXPECT_EQ(met, (std::set<int>{-1, 2, 3, 5, 6, 7}));
    EXPECT_EQ(added, pipeline->counts().clutter.added);
    EXPECT_EQ(dropped("landmarks", "not-finite"), 200) << "not among those withheld";
}

TEST_F(ClutterTest, NoiseIsThatOfTheOthersOrTheConfigs) {
    config.clutter.per_scan = 20;
    const Matrix2 near_ones = (Matrix2() << 0.0625, 0.015625, 0.015625, 0.0078125).finished();
    const Matrix2 far_ones = (Matrix2() << 4, 0, 0, 0.25).finished();
    std::vector<mrpt::obs::CObservation::Ptr> log{
        odometry(0, {}), detections(1, "landmarks", {{10, 0, 1, near_ones}, {40, 0, 2, far_ones}}),
        odometry(2, {})};
    const auto claimed = stepsOf(log);
    std::set<bool> met;
    for (const RangeBearingDetection& d : detectionsOf(claimed.at(0).detections)) {
        EXPECT_TRUE(near(d.covariance, d.range < 25 ? near_ones : far_ones, 1e-15)) << d.range;
        if (!d.source.valid()) met.insert(d.range < 25);
    }
    EXPECT_EQ(met.size(), 2u) << "false ones near and far";

    config.noise.range_std = 0.5;
    config.noise.bearing_std = 0.25;
    const auto stated = stepsOf(log);
    for (const RangeBearingDetection& d : detectionsOf(stated.at(0).detections))
        EXPECT_TRUE(near(d.covariance, Matrix2(Vector2(0.25, 0.0625).asDiagonal()), 1e-15));
}

TEST_F(ClutterTest, DrawsAreThoseOfTheSeed) {
    config.clutter.per_scan = 2;
    config.clutter.detection_probability = 0.5;
    config.seed = 5;
    const auto log = looking(50, {4, 5, 6});
    const auto first = stepsOf(log);
    EXPECT_EQ(measurements(stepsOf(log)), measurements(first));

    config.seed = 6;
    const auto other = stepsOf(log);
    EXPECT_NE(falseOnes(other), falseOnes(first));
    EXPECT_NE(measurements(other).size() - falseOnes(other).size(),
              measurements(first).size() - falseOnes(first).size());
    config.clutter.seed = 5;  // before the run's
    EXPECT_EQ(measurements(stepsOf(log)), measurements(first));

    // The two keys are independent.
    config.clutter.detection_probability = 1;
    EXPECT_EQ(falseOnes(stepsOf(log)), falseOnes(first));
    // What others see changes nothing; the observation's number does.
    EXPECT_EQ(falseOnes(stepsOf(looking(50, {}))), falseOnes(first));
    auto later_ones = log;
    later_ones.insert(later_ones.begin() + 1, detections(0, "landmarks", {}));
    const auto shifted = stepsOf(later_ones);
    const std::vector<run::Step> same_stamps(shifted.begin() + 1, shifted.end());
    EXPECT_NE(falseOnes(same_stamps), falseOnes(first));
}

TEST_F(ClutterTest, ASensorWithoutALargestRangeIsAnError) {
    auto log = looking(1, {4});
    std::dynamic_pointer_cast<mrpt::obs::CObservationBearingRange>(log[2])->maxSensorDistance = 0;
    config.clutter.detection_probability = 0.5;
    EXPECT_NO_THROW(stepsOf(log));
    config.clutter.per_scan = 1;
    const auto error = messageOf<ConfigError>([&] { stepsOf(log); });
    EXPECT_THAT(error, HasSubstr("sensor 'landmarks' has no largest range"));
    EXPECT_THAT(error, HasSubstr("expected [clutter] per_scan = 0"));
}

}  // namespace clutter_test
}  // namespace slamot::test

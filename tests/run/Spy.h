#pragma once
// An estimator that notes all it is given, and what the tests of libs/run feed it with.
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/run/Pipeline.h"
#include "support/TemporaryFolder.h"

namespace slamot {

/// Adds up the pose changes exactly; keeps every call.
class Spy : public Estimator {
    DEFINE_MRPT_OBJECT(Spy, slamot)

  public:
    std::string name() const override { return "spy"; }
    std::string missingInOdometry(const OdometryIncrement&) const override { return missing; }

    Start begin;
    std::vector<OdometryIncrement> predictions;
    std::vector<DetectionSet> sets;
    /// The robot's pose at each set.
    std::vector<Pose2> poses;
    std::string missing;
    /// What it says of itself.
    std::vector<ParticleEstimate> cloud;
    std::vector<LandmarkEstimate> candidates;
    /// CPU time that each update burns [s], in a thread of its own.
    double burn = 0;

  protected:
    std::vector<ParameterTable> onParameters() override { return {}; }
    void onStart(const Start& start) override {
        begin = start;
        pose_ = start.pose;
    }
    void onPredict(const OdometryIncrement& odometry) override {
        predictions.push_back(odometry);
        pose_.mean = pose_.mean * odometry.increment;
    }
    UpdateReport onUpdate(const DetectionSet& detections) override {
        sets.push_back(detections);
        poses.push_back(pose_.mean);
        if (burn > 0) std::thread([this] { burnCpu(burn); }).join();
        return {};
    }
    PoseGaussian onRobot() const override { return pose_; }
    std::vector<ParticleEstimate> onParticles() const override { return cloud; }
    std::vector<LandmarkEstimate> onTentative() const override { return candidates; }

  private:
    static void burnCpu(double seconds) {
        const auto used = [] {
            timespec now{};
            clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
            return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
        };
        while (used() < seconds) {
        }
    }

    PoseGaussian pose_;
};

namespace test {

/// Keeps every step and the end.
struct CollectingSink : run::Sink {
    void observation(const mrpt::obs::CObservation&) override { ++observations; }
    void step(const run::Step& step) override { steps.push_back(step); }
    void end(const run::RunEnd& end) override { ends.push_back(end); }
    int observations = 0;
    std::vector<run::Step> steps;
    std::vector<run::RunEnd> ends;
};

/// Seconds after an epoch that MRPT's clock can hold.
inline Stamp at(double t) {
    return later(action_frame_epoch, t);
}

inline mrpt::obs::CObservation::Ptr odometry(double t, const Pose2& pose,
                                             const std::string& label = "odometry",
                                             std::optional<BodyVelocity> velocity = std::nullopt) {
    return toMrpt(OdometryReading{at(t), pose, velocity}, label);
}

struct Seen {
    double range, bearing;
    std::int64_t id = -1;
    /// Of its own, else the sensor's claim.
    std::optional<Matrix2> covariance = std::nullopt;
};

/// Standard deviations that floats hold exactly, so that expected variances are exact.
inline constexpr double claimed_range_std = 0.5, claimed_bearing_std = 0.125;

inline mrpt::obs::CObservation::Ptr detections(double t, const std::string& label,
                                               const std::vector<Seen>& seen,
                                               double range_std = claimed_range_std,
                                               double bearing_std = claimed_bearing_std) {
    RangeBearingReading reading;
    reading.stamp = at(t);
    reading.sensor.label = label;
    reading.sensor.max_range = 50;
    for (const Seen& one : seen) {
        RangeBearingReading::Item item;
        item.range = one.range;
        item.bearing = one.bearing;
        item.id = SourceId{one.id};
        if (one.covariance) item.covariance = *one.covariance;
        reading.items.push_back(item);
    }
    return toMrpt(reading, range_std, bearing_std);
}

inline mrpt::obs::CObservation::Ptr scan(double t, const std::string& label) {
    auto scan = mrpt::obs::CObservation2DRangeScan::Create();
    scan->timestamp = toMrpt(at(t));
    scan->sensorLabel = label;
    return scan;
}

inline LogEntry entryOf(const mrpt::obs::CObservation::Ptr& observation) {
    return {toStamp(observation->timestamp), observation, std::nullopt, 0};
}

/// A pipeline with a spy in it.
class PipelineTest : public testing::Test {
  protected:
    run::RunConfig config;
    std::shared_ptr<Spy> spy = std::make_shared<Spy>();
    CollectingSink sink;
    const Truth* truth = nullptr;
    int threads = 1;  ///< given to the estimator
    std::unique_ptr<run::Pipeline> pipeline;

    void begin() {
        spy->initialize(Config());
        pipeline =
            std::make_unique<run::Pipeline>(config, *spy, nullptr, truth, threads, std::vector<run::Sink*>{&sink});
    }
    void push(const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
        if (!pipeline) begin();
        for (const auto& observation : observations) pipeline->push(entryOf(observation));
    }
    /// Pushes and finishes.
    void process(const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
        push(observations);
        pipeline->finish(run::RunStatus::complete);
    }
    std::int64_t dropped(const std::string& label, const std::string& reason) const {
        const auto found = pipeline->drops().rows().find({label, reason});
        return found == pipeline->drops().rows().end() ? 0 : found->second;
    }
    static const std::vector<RangeBearingDetection>& detectionsOf(const DetectionSet& set) {
        return set.rangeBearing().detections;
    }
};

/// A folder of the running test, removed at its end.
class FolderTest : public testing::Test {
  protected:
    std::string path(const std::string& name) const { return folder + "/" + name; }
    static std::string textOf(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    static std::string firstLineOf(const std::string& file) {
        const std::string text = textOf(file);
        return text.substr(0, text.find('\n'));
    }

  private:
    const TemporaryFolder temporary_;

  protected:
    const std::string folder = temporary_.path();
};

inline void writeLog(const std::string& file, const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
    RawlogWriter writer(file);
    for (const auto& observation : observations) writer.write(*observation);
    writer.close();
}

}  // namespace test
}  // namespace slamot

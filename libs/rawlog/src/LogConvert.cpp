#include "slamot/rawlog/LogConvert.h"

#include <fmt/format.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/RawlogWriter.h"

namespace slamot {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CObservation;

/// Takes the kept entries of a log in their order.
class LogSink {
  public:
    LogSink(RawlogWriter& writer, ConvertResult& result) : writer_(writer), result_(result) {}
    virtual ~LogSink() = default;
    virtual void take(const LogEntry& entry) = 0;
    virtual void finish() = 0;

  protected:
    RawlogWriter& writer_;
    ConvertResult& result_;
};

bool isOdometry(const LogEntry& entry) {
    return entry.observation && IS_CLASS(*entry.observation, mrpt::obs::CObservationOdometry);
}

/// To observations: these go through; increments become absolute odometry that starts at zero.
class ObservationSink : public LogSink {
  public:
    using LogSink::LogSink;

    void take(const LogEntry& entry) override {
        if (entry.increment) {
            accumulate(*entry.increment);
        } else {
            writer_.write(*entry.observation);
            ++(isOdometry(entry) ? result_.odometry : result_.observations);
        }
    }

    void finish() override {}

  private:
    void accumulate(const OdometryIncrement& increment) {
        if (!started_)
            write({increment.t0, pose_, increment.velocity ? std::optional(BodyVelocity{}) : std::nullopt});
        started_ = true;
        pose_ = pose_ * increment.increment;
        write({increment.t1, pose_, increment.velocity});
    }

    void write(const OdometryReading& reading) {
        writer_.write(*toMrpt(reading, "odometry"));
        ++result_.odometry;
    }

    Pose2 pose_;
    bool started_ = false;
};

CActionRobotMovement2D::Ptr actionOf(const Pose2& way, Stamp stamp) {
    auto action = CActionRobotMovement2D::Create();
    CActionRobotMovement2D::TMotionModelOptions model;  // MRPT's own defaults
    model.modelSelection = CActionRobotMovement2D::mmGaussian;
    action->computeFromOdometry(mrpt::poses::CPose2D(way.x, way.y, way.theta), model);
    action->timestamp = toMrpt(stamp);
    return action;
}

CActionRobotMovement2D::Ptr actionOf(const OdometryIncrement& increment) {
    auto action = actionOf(increment.increment, increment.t1);
    if (const auto& v = increment.velocity) {
        action->hasVelocities = true;
        action->velocityLocal = {v->vx, v->vy, v->omega};
    }
    if (increment.covariance) {
        // A covariance of its own travels in this form only: that of odometry is made anew from a model.
        const Pose2& way = increment.increment;
        action->poseChange = mrpt::poses::CPosePDF::Ptr(std::make_shared<mrpt::poses::CPosePDFGaussian>(
            mrpt::poses::CPose2D(way.x, way.y, way.theta),
            mrpt::math::CMatrixDouble33(*increment.covariance)));
        action->estimationMethod = CActionRobotMovement2D::emScan2DMatching;
    }
    return action;
}

class FrameSink : public LogSink {
  public:
    using LogSink::LogSink;

  protected:
    /// A frame without a movement gets an empty action, since MRPT reads pairs.
    void write(const CActionRobotMovement2D::Ptr& action, const std::vector<CObservation::Ptr>& seen) {
        mrpt::obs::CSensoryFrame frame;
        for (const auto& observation : seen) frame.insert(observation);
        writer_.writeFrame(collection(action), frame);
        result_.observations += static_cast<std::int64_t>(seen.size());
    }

    /// The way after the last observation. It gets no sensory frame, since kf-slam fails at an empty one.
    void writeLast(const CActionRobotMovement2D::Ptr& action) { writer_.writeAction(collection(action)); }

  private:
    mrpt::obs::CActionCollection collection(const CActionRobotMovement2D::Ptr& action) {
        mrpt::obs::CActionCollection actions;
        if (action) actions.insert(*action);
        if (action) ++result_.odometry;
        return actions;
    }
};

/// Observations of one stamp become a sensory frame; the action before it is the way since the frame before.
class FramesFromReadings : public FrameSink {
  public:
    using FrameSink::FrameSink;

    void take(const LogEntry& entry) override {
        if (isOdometry(entry)) {
            if (label_.value_or(entry.observation->sensorLabel) != entry.observation->sensorLabel) {
                ++result_.left_out;  // a second odometry: one action has one movement
                return;
            }
            label_ = entry.observation->sensorLabel;
            move(fromMrpt(dynamic_cast<const mrpt::obs::CObservationOdometry&>(*entry.observation)));
            return;
        }
        if (waiting_.empty() || waiting_.back().stamp != entry.stamp) waiting_.push_back({entry.stamp, {}});
        waiting_.back().observations.push_back(entry.observation);
    }

    void finish() override {
        for (const auto& frame : waiting_) writeWithoutOdometry(frame, last_ ? last_->pose : moved_to_);
        waiting_.clear();
        if (!last_) return;
        const Pose2 rest = inverse(moved_to_) * last_->pose;
        if (rest.x != 0 || rest.y != 0 || rest.theta != 0) writeLast(actionOf(rest, last_->stamp));
    }

  private:
    struct Frame {
        Stamp stamp;
        std::vector<CObservation::Ptr> observations;
    };

    void move(const OdometryReading& reading) {
        if (!last_) {
            moved_to_ = reading.pose;
            for (const auto& frame : waiting_) {
                if (frame.stamp < reading.stamp)
                    writeWithoutOdometry(frame, reading.pose);
                else
                    writeAt(frame, reading.pose);
            }
        } else {
            for (const auto& frame : waiting_) writeAt(frame, poseBetween(*last_, reading, frame.stamp));
        }
        waiting_.clear();
        last_ = reading;
    }

    /// At constant body velocity from `a` to `b`.
    static Pose2 poseBetween(const OdometryReading& a, const OdometryReading& b, Stamp t) {
        if (t <= a.stamp) return a.pose;
        if (t >= b.stamp) return b.pose;
        OdometryIncrement way;
        way.t0 = a.stamp;
        way.t1 = b.stamp;
        way.increment = inverse(a.pose) * b.pose;
        way.entry_seconds = way.seconds();
        return a.pose * split(way, t).before.increment;
    }

    void writeAt(const Frame& frame, const Pose2& pose) {
        write(actionOf(inverse(moved_to_) * pose, frame.stamp), frame.observations);
        moved_to_ = pose;
    }

    void writeWithoutOdometry(const Frame& frame, const Pose2& pose) {
        result_.without_odometry += static_cast<std::int64_t>(frame.observations.size());
        writeAt(frame, pose);
    }

    std::optional<std::string> label_;
    std::vector<Frame> waiting_;  ///< for odometry that covers their stamp
    std::optional<OdometryReading> last_;
    Pose2 moved_to_;  ///< odometry's pose at the last frame written
};

/// Frames stay as they are.
class FramesFromIncrements : public FrameSink {
  public:
    using FrameSink::FrameSink;

    void take(const LogEntry& entry) override {
        if (entry.increment || (stamp_ && entry.stamp != *stamp_)) flush();
        stamp_ = entry.stamp;
        if (entry.increment)
            action_ = actionOf(*entry.increment);
        else
            seen_.push_back(entry.observation);
    }

    void finish() override {
        if (action_ && seen_.empty())
            writeLast(action_);
        else
            flush();
    }

  private:
    void flush() {
        if (action_ || !seen_.empty()) write(action_, seen_);
        action_.reset();
        seen_.clear();
    }

    std::optional<Stamp> stamp_;
    CActionRobotMovement2D::Ptr action_;
    std::vector<CObservation::Ptr> seen_;
};

std::unique_ptr<LogSink> makeSink(LogFormat from, LogFormat to, RawlogWriter& writer, ConvertResult& result) {
    if (to == LogFormat::observations) return std::make_unique<ObservationSink>(writer, result);
    if (from == LogFormat::observations) return std::make_unique<FramesFromReadings>(writer, result);
    return std::make_unique<FramesFromIncrements>(writer, result);
}

bool isKept(const LogEntry& entry, const ConvertOptions& options) {
    if ((options.from && entry.stamp < *options.from) || (options.to && entry.stamp > *options.to))
        return false;
    if (entry.increment || isOdometry(entry)) return true;
    const auto& labels = options.labels;
    return labels.empty() ||
           std::find(labels.begin(), labels.end(), entry.observation->sensorLabel) != labels.end();
}

}  // namespace

ConvertResult convertLog(const std::string& in, const std::string& out, const LogParameters& parameters,
                         const ConvertOptions& options, const std::function<bool(double)>& progress) {
    std::error_code error;
    if (std::filesystem::equivalent(in, out, error))
        throw LogError(fmt::format("{}: is the log that is read, expected another name to write to", out));
    RawlogReader reader(in, parameters);
    RawlogWriter writer(out);
    ConvertResult result;
    result.format = options.format.value_or(reader.format());
    const auto sink = makeSink(reader.format(), result.format, writer, result);

    while (const auto entry = reader.next()) {
        if (progress && !progress(reader.progress()))
            throw LogError(
                fmt::format("{}: stopped before its end, {}.part holds what was written", in, out));
        if (isKept(*entry, options))
            sink->take(*entry);
        else
            ++result.left_out;
    }
    sink->finish();
    writer.close();
    result.end = reader.end();
    result.end_message = reader.endMessage();
    result.drops = reader.drops();
    return result;
}

}  // namespace slamot

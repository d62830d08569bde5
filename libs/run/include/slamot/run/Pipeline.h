#pragma once
// From log entries to estimates: the one place where odometry and detections are put in step. Push-based: the
// caller reads (or receives) entries in order and pushes them.
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "slamot/core/plugin/Detector.h"
#include "slamot/core/plugin/Estimator.h"
#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/RawlogReader.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/run/DetectionBuilder.h"
#include "slamot/run/RunConfig.h"
#include "slamot/run/Sink.h"

namespace slamot::run {

/// Counters of a pipeline.
struct PipelineCounts {
    std::int64_t odometry = 0, detection_sets = 0, detections = 0, scans = 0;
    /// Entries longer than max_odometry_gap, and frames without a movement: bridged.
    std::int64_t odometry_gaps = 0;
    std::int64_t extrapolated = 0;  ///< detection sets after the last odometry, reached at constant velocity
    ClutterCounts clutter;
    StageTimes times;
};

/// Detections are held until odometry covering their stamp has arrived; that entry is then split at the stamp. All
/// range-bearing observations of one stamp become one DetectionSet. Detections before the first odometry (not
/// those of its very stamp, where the run starts) or too long after the last are dropped and counted.
class Pipeline {
   public:
    /// `truth` may be null; it is read for `[start] pose = truth` only.
    Pipeline(const RunConfig& config, Estimator& estimator, Detector* detector, const Truth* truth, int threads,
             std::vector<Sink*> sinks);
    Pipeline(const Pipeline&) = delete;

    void push(const LogEntry& entry);
    /// No more entries: processes what is held. The sinks are not told of the end yet.
    void drain();
    /// Drains and tells the sinks that the run has ended, and how.
    void finish(RunStatus status);

    /// Ends what has not ended yet with status failed, after an EstimatorError: with the last estimate that went to
    /// the sinks, without asking the estimator anything.
    void fail();

    const DropTable& drops() const { return drops_; }
    const PipelineCounts& counts() const { return counts_; }
    /// Sensor labels met so far.
    const std::set<std::string>& labels() const { return labels_; }
    bool started() const { return started_; }
    /// Why the first observation dropped as 'unusable' was, empty when none was.
    const std::string& firstUnusable() const { return first_unusable_; }

   private:
    /// Observations of one stamp, waiting for odometry.
    struct Held {
        Stamp stamp;
        std::vector<HeldReading> readings;
        std::vector<mrpt::obs::CObservation::Ptr> scans;
    };

    /// What MRPT's observation says, or nothing, counted, when it makes no sense.
    template <class Observation>
    auto usable(const Observation& observation) -> std::optional<decltype(fromMrpt(observation))>;
    void pushIncrement(const OdometryIncrement& odometry);
    void pushOdometry(const OdometryReading& reading, const std::string& label);
    void pushDetections(const mrpt::obs::CObservationBearingRange& seen, Stamp stamp);
    void pushScan(const mrpt::obs::CObservation::Ptr& scan, Stamp stamp);
    /// Where what was seen at `stamp` waits; null when that is too long after the last odometry.
    Held* holdFor(Stamp stamp);
    void dropHeldBefore(Stamp stamp);
    void drop(const Held& held, const std::string& reason);
    void start(Stamp stamp);
    /// Goes through an odometry entry, taking in what is held on the way.
    void advance(const OdometryIncrement& odometry);
    /// Predicts to `stamp` with the first part of `rest`, which keeps the remainder.
    void predictTo(OdometryIncrement& rest, Stamp stamp);
    void take(const Held& held);
    void closeStep();
    void endSinks(const RunEnd& end);

    const RunConfig& config_;
    Estimator& estimator_;
    Detector* detector_;
    const Truth* truth_;
    int threads_;
    std::vector<Sink*> sinks_;

    DropTable drops_;
    PipelineCounts counts_;
    DetectionBuilder builder_;
    std::set<std::string> labels_;
    bool started_ = false;
    std::string odometry_label_;
    std::optional<OdometryReading> last_reading_;
    std::optional<OdometryIncrement> last_increment_;
    std::vector<Held> held_;           ///< in order of stamp
    std::map<Stamp, int> log_counts_;  ///< detections that the log has at a stamp, from the first one held
    std::uint32_t observations_ = 0;   ///< range-bearing observations so far
    Step step_;               ///< of the estimator's present time; goes to the sinks when time moves on
    Estimate last_estimate_;  ///< of the last closed step
    std::size_t ended_ = 0;   ///< sinks that know of the end
    std::string first_unusable_;
};

}  // namespace slamot::run

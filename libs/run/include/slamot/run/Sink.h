#pragma once
// What a run produces, step by step, and those who take it.
#include <mrpt/obs/CObservation.h>

#include <string>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/plugin/Estimator.h"

namespace slamot::run {

enum class RunStatus { complete, stopped, truncated, corrupt, failed };
const char* toText(RunStatus status);

/// Wall time and CPU time [s] by stage; CPU time of all threads that the estimator was given.
struct StageTimes {
    double predict = 0, detect = 0, update = 0;
    double predict_cpu = 0, detect_cpu = 0, update_cpu = 0;
    StageTimes& operator+=(const StageTimes& other) {
        predict += other.predict;
        detect += other.detect;
        update += other.update;
        predict_cpu += other.predict_cpu;
        detect_cpu += other.detect_cpu;
        update_cpu += other.update_cpu;
        return *this;
    }
};

/// One stamp, after all its events.
struct Step {
    Estimate estimate;
    /// What was taken in at this stamp; both empty when nothing was.
    bool has_detections = false;
    DetectionSet detections;
    /// Of each detection: its number among the detections that the log has at this stamp, used or not, as
    /// truth's associations count; -1 for those that [clutter] added, log_count and more for those found in
    /// scans.
    std::vector<int> log_numbers;
    int log_count = 0;
    UpdateReport report;
    /// The landmarks named in the report, after the update.
    std::vector<LandmarkEstimate> touched;
    StageTimes times;
    /// For what is expensive and only some sinks want; at this step, so not to be kept.
    const Estimator* estimator = nullptr;
};

/// The end of a run.
struct RunEnd {
    RunStatus status = RunStatus::complete;
    Estimate estimate;
    std::vector<LandmarkEstimate> landmarks;
    /// For what is expensive and only some sinks want. Null when there is none to ask: it was never started, or failed.
    const Estimator* estimator = nullptr;
};

class Sink {
   public:
    virtual ~Sink() = default;
    /// Every observation of the log that the run was given, in order.
    virtual void observation(const mrpt::obs::CObservation&) {}
    virtual void step(const Step& step) = 0;
    virtual void end(const RunEnd&) {}
    /// Seconds that the sink held the run back for a person who watches: no part of what the run costs.
    virtual double heldBack() const { return 0; }
};

}  // namespace slamot::run

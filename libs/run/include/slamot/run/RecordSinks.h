#pragma once
// Sinks that keep a run in memory instead of files: for metrics, summaries and studies.
#include <map>
#include <string>
#include <vector>

#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Sha256.h"
#include "slamot/run/CsvSinks.h"

namespace slamot::run {

/// The run as the metrics want it; the same rows that the CSV sinks write.
class RunRecorder : public Sink {
   public:
    RunRecorder(double interval, std::vector<std::string> mode_names) : clock_(interval) {
        record_.mode_names = std::move(mode_names);
    }
    void step(const Step& step) override;
    void end(const RunEnd& end) override { record_.landmarks = end.landmarks; }
    const eval::RunRecord& record() const { return record_; }

   private:
    RowClock clock_;
    eval::RunRecord record_;
};

/// SHA-256 over the bits of every robot pose, track and final landmark: two runs with equal hashes gave the same
/// estimates.
class EstimateHash : public Sink {
   public:
    void step(const Step& step) override;
    void end(const RunEnd& end) override;
    /// Hex; after the end.
    const std::string& hex() const { return hex_; }

   private:
    void addInteger(std::int64_t value) { sum_.add(&value, sizeof value); }
    void addNumbers(const double* values, std::size_t count) { sum_.add(values, count * sizeof(double)); }

    Sha256 sum_;
    std::string hex_;
};

/// Wall time of every step with detections [s], for percentiles.
class StepTimer : public Sink {
   public:
    void step(const Step& step) override;
    /// Quantile q of the time between two outputs with detections, prediction included; NaN without any.
    double percentile(double q) const;
    /// NaN without any.
    double mean() const;
    std::size_t count() const { return seconds_.size(); }

   private:
    double pending_ = 0;
    std::vector<double> seconds_;
};

/// The sensors that detections came from, by label, each as it was last.
class SensorRecord : public Sink {
   public:
    void step(const Step& step) override;
    const std::map<std::string, RangeBearingSensor>& sensors() const { return sensors_; }

   private:
    std::map<std::string, RangeBearingSensor> sensors_;
};

}  // namespace slamot::run

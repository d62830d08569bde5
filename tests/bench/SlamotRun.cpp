#include <stdexcept>

#include "StepClock.h"
#include "Trial.h"
#include "slamot/run/Pipeline.h"

namespace slamot::bench {
namespace {

/// Keeps poses and counts. The pipeline closes a step when time moves on, so number 0 is the start.
class TrialSink : public run::Sink {
  public:
    explicit TrialSink(Trial& trial) : trial_(trial) {}
    void step(const run::Step& step) override {
        if (started_) {
            trial_.poses.push_back(step.estimate.robot.mean);
            trial_.landmarks.push_back(static_cast<int>(step.estimate.landmark_count));
            trial_.seen.push_back(static_cast<int>(step.detections.rangeBearing().detections.size()));
        }
        started_ = true;
    }

  private:
    Trial& trial_;
    bool started_ = false;
};

}  // namespace

Trial runSlamot(const std::string& log, const std::string& config_file,
                const std::vector<std::string>& settings, bool certain_start) {
    static const PluginRegistry registry = PluginRegistry::discover();
    Config config = Config::fromFile(config_file);
    for (const std::string& setting : settings) config.setFromAssignment(setting);
    const run::AssembledRun assembled = run::assembleRun(config, registry);

    RawlogReader reader(log, assembled.config.log);
    std::vector<LogEntry> entries;
    bool moved_and_seen = false;
    while (auto entry = reader.next()) {
        if (certain_start && entry->increment && !moved_and_seen)
            entry->increment->covariance = Matrix3::Zero();
        moved_and_seen |= !entry->increment && !entries.empty() && entries.back().increment;
        entries.push_back(std::move(*entry));
    }
    if (reader.end() != LogEnd::clean) throw std::runtime_error(log + ": " + reader.endMessage());

    Trial trial;
    TrialSink sink(trial);
    run::Pipeline pipeline(assembled.config, *assembled.estimator, nullptr, nullptr, 1, {&sink});
    // The detections of a frame are taken in when the next movement arrives, so a frame's time is that of
    // what lies between two movements: its update and the prediction of the next.
    double begin = 0;
    bool within = false;
    for (const LogEntry& entry : entries) {
        if (entry.increment && within) {
            pipeline.push(entry);
            const double now = threadSeconds();
            trial.seconds.push_back(now - begin);
            begin = now;
        } else {
            pipeline.push(entry);
            if (entry.increment) begin = threadSeconds();
            within |= entry.increment.has_value();
        }
    }
    pipeline.finish(run::RunStatus::complete);
    return trial;
}

}  // namespace slamot::bench

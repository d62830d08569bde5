#include "slamot/run/Run.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <set>

#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/run/RecordSinks.h"
#include "slamot/run/Summary.h"

namespace slamot::run {
namespace {

/// Keeps the end of the run for the summary.
class EndKeeper : public Sink {
  public:
    void step(const Step&) override {}
    void end(const RunEnd& end) override { kept = end; }
    RunEnd kept;
};

std::string dropsInWords(const DropTable& drops) {
    std::string text;
    for (const auto& [key, count] : drops.rows())
        text += fmt::format("{}{} of '{}' ({})", text.empty() ? "" : ", ", count, key.first, key.second);
    return text.empty() ? "nothing else was in it" : "not used: " + text;
}

/// A run that used nothing is an error that says what was found.
void requireUsed(const Pipeline& pipeline, const Estimator& estimator, const std::string& log,
                 const DropTable& drops) {
    const std::string detail = pipeline.firstUnusable().empty() ? "" : "; first: " + pipeline.firstUnusable();
    if (!pipeline.started())
        throw LogError(
            fmt::format("{}: has no odometry to start with (CObservationOdometry, or actions of "
                        "action-frame logs); {}{}",
                        log, dropsInWords(drops), detail));
    const PipelineCounts& counts = pipeline.counts();
    if (estimator.usesDetections() && counts.detections == 0 && counts.clutter.withheld == 0)
        throw LogError(
            fmt::format("{}: has no detection that {} can use (CObservationBearingRange with a role in "
                        "[sensors], or lidar with a detector); {}{}",
                        log, estimator.name(), dropsInWords(drops), detail));
    const Health health = estimator.estimate().health;
    if (estimator.usesDetections() && health.detections_ignored > 0 &&
        health.detections_used + health.detections_inflated + health.detections_rejected +
                health.detections_tentative ==
            0)
        throw LogError(
            fmt::format("{}: {} had no use for any of the {} detections: as it is set ([...association]) it "
                        "goes by identities, but "
                        "they are hidden ([identities]), -1 in the log, or of sensors with role mixed",
                        log, estimator.name(), health.detections_ignored));
}

RunStatus statusOf(const LogSource& source, bool stopped) {
    if (stopped) return RunStatus::stopped;
    if (source.end() == LogEnd::truncated) return RunStatus::truncated;
    return source.end() == LogEnd::corrupt ? RunStatus::corrupt : RunStatus::complete;
}

/// Whether it was stopped before the log's end.
bool pushAll(Pipeline& pipeline, const RunInput& input) {
    std::int64_t entries = 0;
    while (auto entry = input.source->next()) {
        pipeline.push(*entry);
        if (++entries % 64 == 0 && input.progress) input.progress(input.source->progress());
        if (input.stop && input.stop->load()) return true;
    }
    return false;
}

DropTable dropsOf(const LogSource& source, const Pipeline& pipeline) {
    DropTable drops = source.drops();
    for (const auto& [key, count] : pipeline.drops().rows()) drops.add(key.first, key.second, count);
    return drops;
}

/// A label in the config that the log does not have is a slip that nothing else would show.
std::vector<std::string> labelWarnings(const RunConfig& config, const Pipeline& pipeline,
                                       const DropTable& drops) {
    std::set<std::string> met = pipeline.labels();
    for (const auto& [key, count] : drops.rows()) met.insert(key.first);
    const std::vector<std::string> words(met.begin(), met.end());
    std::vector<std::string> warnings;
    const auto check = [&](const std::string& section, const std::string& label) {
        if (met.count(label)) return;
        const auto near = nearestWord(label, words);
        warnings.push_back(fmt::format("{} names sensor '{}', which the log does not have{}", section, label,
                                       near ? " (did you mean '" + *near + "'?)" : ""));
    };
    for (const auto& [label, role] : config.sensors.by_label) check("[sensors]", label);
    for (const auto& [label, noise] : config.noise_by_label) check("[noise." + label + "]", label);
    return warnings;
}

}  // namespace

RunResult runSource(const AssembledRun& assembled, const RunInput& input) {
    const auto wall_begin = std::chrono::steady_clock::now();
    const std::clock_t cpu_begin = std::clock();
    RunRecorder recorder(assembled.config.output.interval, assembled.estimator->modeNames());
    EstimateHash hash;
    StepTimer timer;
    EndKeeper end;
    SensorRecord sensors;
    std::vector<Sink*> sinks{&recorder, &hash, &timer, &end, &sensors};
    sinks.insert(sinks.end(), input.sinks.begin(), input.sinks.end());

    Pipeline pipeline(assembled.config, *assembled.estimator, assembled.detector.get(), input.truth,
                      input.threads, sinks);
    RunResult result;
    DropTable drops;
    bool stopped = false;
    try {
        stopped = pushAll(pipeline, input);
        pipeline.drain();
        drops = dropsOf(*input.source, pipeline);
        // Before any output gets its final name: a run that used nothing leaves none that looks finished.
        if (!stopped) requireUsed(pipeline, *assembled.estimator, input.log_name, drops);
        pipeline.finish(statusOf(*input.source, stopped));
    } catch (const EstimatorError& error) {
        result.failure = std::current_exception();
        result.end_message = error.what();
        drops = dropsOf(*input.source, pipeline);
        pipeline.fail();
    }
    result.status = result.failure ? RunStatus::failed : statusOf(*input.source, stopped);
    if (!result.failure) result.end_message = input.source->endMessage();
    // Of a log that was not read to its end, what is missing may come later.
    if (result.status == RunStatus::complete)
        result.warnings = labelWarnings(assembled.config, pipeline, drops);
    result.started = pipeline.started();
    result.estimate_hash = hash.hex();
    result.record = recorder.record();
    if (input.truth && pipeline.started() && !result.failure)
        result.metrics = eval::evaluate(result.record, *input.truth, assembled.evaluation);

    SummaryInput summary;
    summary.status = result.status;
    summary.end_message = result.end_message;
    summary.log_file = input.log_name;
    summary.truth_folder = input.truth ? input.truth_name : "";
    summary.canonical_config = assembled.canonical_config;
    summary.estimator = assembled.estimator->name();
    summary.detector = assembled.config.detector;
    summary.estimate_hash = result.estimate_hash;
    summary.seed = assembled.config.seed;
    summary.threads = input.threads;
    summary.counts = &pipeline.counts();
    summary.timer = &timer;
    summary.drops = drops;
    summary.sensors = sensors.sensors();
    summary.warnings = result.warnings;
    summary.end = end.kept;
    if (result.metrics) summary.metrics = eval::toJson(*result.metrics);
    summary.wall_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_begin).count();
    for (const Sink* sink : sinks) summary.wall_seconds -= sink->heldBack();
    summary.cpu_seconds = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    result.summary = makeSummary(summary);
    return result;
}

}  // namespace slamot::run

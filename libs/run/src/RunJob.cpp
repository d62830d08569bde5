#include "slamot/run/RunJob.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <exception>
#include <filesystem>
#include <memory>
#include <set>

#include "slamot/core/config/Parameters.h"
#include "slamot/eval/Metrics.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/run/CsvSinks.h"
#include "slamot/run/MrptSinks.h"
#include "slamot/run/RecordSinks.h"
#include "slamot/run/Summary.h"

namespace slamot::run {
namespace {

namespace fs = std::filesystem;

/// What a run may leave in its folder.
constexpr const char* output_names[] = {
    "trajectory.csv", "trajectory.tum", "tracks.csv", "landmarks.csv", "landmarks_history.csv", "innovations.csv",
    "steps.csv", "correlation.bin", "map.landmarks.gz", "scene.3Dscene", "estimate.rawlog", "estimate.rawlog.sha256",
    "summary.json", "overview.svg", "overview.png", "overview.vg.json"};

/// Names alone do not tell an estimate from somebody's data, so a folder is only written to when it is empty or the
/// output of an earlier run, finished or broken off.
void requireOwnFolder(const std::string& folder) {
    const bool earlier_run = fs::exists(folder + "/summary.json") || fs::exists(folder + "/trajectory.csv.part");
    for (const char* name : output_names)
        if (!earlier_run && fs::exists(folder + "/" + name))
            throw LogError(fmt::format("{}/{}: no run has left this there, expected a new folder for the outputs", folder,
                                       name));
}

/// Makes the folder and removes what an earlier run left there, so that no old file passes for a new one. The log
/// itself may not be among that.
void prepareFolder(const std::string& folder, const std::string& log_file) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder))
        throw LogError(fmt::format("{}: cannot be made ({}), expected a folder to write to", folder,
                                   error ? error.message() : "it is no folder"));
    for (const char* name : output_names)
        if (fs::equivalent(folder + "/" + name, log_file, error))
            throw LogError(fmt::format("{}/{}: is the log to read and would be overwritten, expected another output folder",
                                       folder, name));
    requireOwnFolder(folder);
    for (const char* name : output_names)
        for (const char* suffix : {"", ".part"}) {
            const std::string file = fmt::format("{}/{}{}", folder, name, suffix);
            fs::remove(file, error);
            if (error) throw LogError(fmt::format("{}: cannot be replaced ({})", file, error.message()));
        }
}

std::vector<std::unique_ptr<Sink>> fileSinks(const RunConfig& config, const std::string& folder,
                                             const std::vector<std::string>& mode_names) {
    const OutputParameters& output = config.output;
    std::vector<std::unique_ptr<Sink>> sinks;
    sinks.push_back(std::make_unique<TrajectorySink>(folder, output.interval));
    sinks.push_back(std::make_unique<TracksSink>(folder, output.interval, mode_names));
    sinks.push_back(std::make_unique<LandmarksSink>(folder));
    if (output.innovations) sinks.push_back(std::make_unique<InnovationsSink>(folder));
    if (output.landmarks_history) sinks.push_back(std::make_unique<LandmarksHistorySink>(folder));
    if (output.steps) sinks.push_back(std::make_unique<StepsSink>(folder));
    if (output.correlation) sinks.push_back(std::make_unique<CorrelationSink>(folder));
    if (output.map) sinks.push_back(std::make_unique<LandmarkMapSink>(folder));
    if (output.scene) sinks.push_back(std::make_unique<SceneSink>(folder));
    if (output.rawlog) sinks.push_back(std::make_unique<EstimateLogSink>(folder));
    return sinks;
}

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
void requireUsed(const Pipeline& pipeline, const Estimator& estimator, const std::string& log, const DropTable& drops) {
    const std::string detail = pipeline.firstUnusable().empty() ? "" : "; first: " + pipeline.firstUnusable();
    if (!pipeline.started())
        throw LogError(fmt::format("{}: has no odometry to start with (CObservationOdometry, or actions of "
                                   "action-frame logs); {}{}",
                                   log, dropsInWords(drops), detail));
    if (estimator.usesDetections() && pipeline.counts().detections == 0)
        throw LogError(fmt::format("{}: has no detection that {} can use (CObservationBearingRange with a role in "
                                   "[sensors], or lidar with a detector); {}{}",
                                   log, estimator.name(), dropsInWords(drops), detail));
    const Health health = estimator.estimate().health;
    if (estimator.usesDetections() && health.detections_ignored > 0 &&
        health.detections_used + health.detections_inflated + health.detections_rejected == 0)
        throw LogError(fmt::format("{}: {} had no use for any of the {} detections: it needs identities, but they are "
                                   "hidden ([identities]), -1 in the log, or of sensors with role mixed",
                                   log, estimator.name(), health.detections_ignored));
}

RunStatus statusOf(const RawlogReader& reader, bool stopped) {
    if (stopped) return RunStatus::stopped;
    if (reader.end() == LogEnd::truncated) return RunStatus::truncated;
    return reader.end() == LogEnd::corrupt ? RunStatus::corrupt : RunStatus::complete;
}

/// Whether it was stopped before the log's end.
bool pushAll(RawlogReader& reader, Pipeline& pipeline, const RunRequest& request) {
    std::int64_t entries = 0;
    while (auto entry = reader.next()) {
        pipeline.push(*entry);
        if (++entries % 64 == 0 && request.progress) request.progress(reader.progress());
        if (request.stop && request.stop->load()) return true;
    }
    return false;
}

DropTable dropsOf(const RawlogReader& reader, const Pipeline& pipeline) {
    DropTable drops = reader.drops();
    for (const auto& [key, count] : pipeline.drops().rows()) drops.add(key.first, key.second, count);
    return drops;
}

/// A label in the config that the log does not have is a slip that nothing else would show.
std::vector<std::string> labelWarnings(const RunConfig& config, const Pipeline& pipeline, const DropTable& drops) {
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

RunResult runLog(const RunRequest& request, const PluginRegistry& registry) {
    const auto wall_begin = std::chrono::steady_clock::now();
    const std::clock_t cpu_begin = std::clock();
    const AssembledRun assembled = assembleRun(request.config, registry);
    eval::EvaluationOptions evaluation;
    load(describe(evaluation), request.config);
    RawlogReader reader(request.log_file, assembled.config.log);

    const std::string& folder = request.out_folder;
    prepareFolder(folder, request.log_file);
    const auto files = fileSinks(assembled.config, folder, assembled.estimator->modeNames());
    RunRecorder recorder(assembled.config.output.interval, assembled.estimator->modeNames());
    EstimateHash hash;
    StepTimer timer;
    EndKeeper end;
    std::vector<Sink*> sinks{&recorder, &hash, &timer, &end};
    for (const auto& sink : files) sinks.push_back(sink.get());

    Pipeline pipeline(assembled.config, *assembled.estimator, assembled.detector.get(), request.truth, request.threads,
                      sinks);
    bool stopped = false;
    std::exception_ptr failure;
    std::string failure_message;
    DropTable drops;
    try {
        stopped = pushAll(reader, pipeline, request);
        pipeline.drain();
        drops = dropsOf(reader, pipeline);
        // Before any output gets its final name: a run that used nothing leaves none that looks finished.
        if (!stopped) requireUsed(pipeline, *assembled.estimator, request.log_file, drops);
        pipeline.finish(statusOf(reader, stopped));
    } catch (const EstimatorError& error) {
        failure = std::current_exception();
        failure_message = error.what();
        drops = dropsOf(reader, pipeline);
        pipeline.fail();
    }
    const RunStatus status = failure ? RunStatus::failed : statusOf(reader, stopped);

    RunResult result;
    result.status = status;
    result.end_message = failure ? failure_message : reader.endMessage();
    // Of a log that was not read to its end, what is missing may come later.
    if (status == RunStatus::complete) result.warnings = labelWarnings(assembled.config, pipeline, drops);
    result.estimate_hash = hash.hex();
    result.record = recorder.record();
    result.writes_figure = assembled.config.output.figure && pipeline.started();

    SummaryInput summary;
    summary.status = status;
    summary.end_message = result.end_message;
    summary.log_file = request.log_file;
    summary.truth_folder = request.truth ? request.truth_folder : "";
    summary.canonical_config = assembled.canonical_config;
    summary.estimator = assembled.estimator->name();
    summary.detector = assembled.config.detector;
    summary.estimate_hash = result.estimate_hash;
    summary.seed = assembled.config.seed;
    summary.threads = request.threads;
    summary.counts = &pipeline.counts();
    summary.timer = &timer;
    summary.drops = drops;
    summary.warnings = result.warnings;
    summary.end = end.kept;
    if (request.truth && pipeline.started() && !failure) {
        const eval::Metrics metrics = eval::evaluate(result.record, *request.truth, evaluation);
        summary.metrics = eval::toJson(metrics);
        result.metrics_table = eval::summaryTable(metrics);
    }
    summary.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_begin).count();
    summary.cpu_seconds = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    result.summary = makeSummary(summary);
    PartFile file(folder + "/summary.json");
    // Labels of a log may be no UTF-8.
    file.line(result.summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    file.close();
    if (failure) std::rethrow_exception(failure);
    return result;
}

}  // namespace slamot::run

#include "slamot/run/OutputFolder.h"

#include <fmt/format.h>

#include <filesystem>

#include "slamot/rawlog/LogError.h"
#include "slamot/run/CsvSinks.h"
#include "slamot/run/MrptSinks.h"

namespace slamot::run {
namespace {

namespace fs = std::filesystem;

/// What a run may leave in its folder.
constexpr const char* output_names[] = {
    "trajectory.csv",        "trajectory.tum",  "tracks.csv",      "landmarks.csv",
    "landmarks_history.csv", "innovations.csv", "steps.csv",       "correlation.bin",
    "map.landmarks.gz",      "scene.3Dscene",   "estimate.rawlog", "estimate.rawlog.sha256",
    "summary.json",          "overview.svg",    "overview.png",    "overview.vg.json",
    "report.html",           "tentative.csv",   "particles.csv"};

/// Names alone do not tell an estimate from somebody's data, so a folder is only written to when it is empty
/// or the output of an earlier run, finished or broken off.
void requireOwnFolder(const std::string& folder) {
    const bool earlier_run =
        fs::exists(folder + "/summary.json") || fs::exists(folder + "/trajectory.csv.part");
    for (const char* name : output_names)
        if (!earlier_run && fs::exists(folder + "/" + name))
            throw LogError(fmt::format(
                "{}/{}: no run has left this there, expected a new folder for the outputs", folder, name));
}

/// Makes the folder and removes what an earlier run left there, so that no old file passes for a new one. The
/// log itself may not be among that.
void prepareFolder(const std::string& folder, const std::string& log_file) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!fs::is_directory(folder))
        throw LogError(fmt::format("{}: cannot be made ({}), expected a folder to write to", folder,
                                   error ? error.message() : "it is no folder"));
    for (const char* name : output_names)
        if (fs::equivalent(folder + "/" + name, log_file, error))
            throw LogError(fmt::format(
                "{}/{}: is the log to read and would be overwritten, expected another output folder", folder,
                name));
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
    if (output.tentative) sinks.push_back(std::make_unique<TentativeSink>(folder, output.interval));
    if (output.particles)
        sinks.push_back(std::make_unique<ParticlesSink>(folder, output.interval, output.most_particles));
    if (output.steps) sinks.push_back(std::make_unique<StepsSink>(folder));
    if (output.correlation) sinks.push_back(std::make_unique<CorrelationSink>(folder));
    if (output.map) sinks.push_back(std::make_unique<LandmarkMapSink>(folder));
    if (output.scene) sinks.push_back(std::make_unique<SceneSink>(folder));
    if (output.rawlog) sinks.push_back(std::make_unique<EstimateLogSink>(folder));
    return sinks;
}

}  // namespace

OutputFolder::OutputFolder(const std::string& folder, const AssembledRun& assembled,
                           const std::string& log_file)
    : folder_(folder) {
    prepareFolder(folder, log_file);
    sinks_ = fileSinks(assembled.config, folder, assembled.estimator->modeNames());
}

std::vector<Sink*> OutputFolder::sinks() const {
    std::vector<Sink*> all;
    for (const auto& sink : sinks_) all.push_back(sink.get());
    return all;
}

void OutputFolder::writeSummary(const nlohmann::json& summary) const {
    PartFile file(folder_ + "/summary.json");
    // Labels of a log may be no UTF-8.
    file.line(summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    file.close();
}

}  // namespace slamot::run

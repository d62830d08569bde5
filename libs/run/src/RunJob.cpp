#include "slamot/run/RunJob.h"

#include "slamot/rawlog/RawlogReader.h"
#include "slamot/run/OutputFolder.h"

namespace slamot::run {
JobResult runLog(const RunRequest& request, const PluginRegistry& registry) {
    const AssembledRun assembled = assembleRun(request.config, registry);
    RawlogReader reader(request.log_file, assembled.config.log);
    OutputFolder folder(request.out_folder, assembled, request.log_file);

    RunInput input;
    input.source = &reader;
    input.log_name = request.log_file;
    input.truth = request.truth;
    input.truth_name = request.truth_folder;
    input.threads = request.threads;
    input.progress = request.progress;
    input.stop = request.stop;
    input.sinks = folder.sinks();
    input.sinks.insert(input.sinks.end(), request.sinks.begin(), request.sinks.end());

    JobResult result{runSource(assembled, input), {}, false, false};
    result.writes_figure = assembled.config.output.figure && result.started;
    result.writes_report = assembled.config.output.report && result.started;
    if (result.metrics) result.metrics_table = eval::summaryTable(*result.metrics);
    folder.writeSummary(result.summary);
    return result;
}

}  // namespace slamot::run

#include <limits>

#include "MapSizeReport.h"
#include "TableFields.h"

namespace slamot::bench {
namespace {

struct StepKind {
    const char* name;
    bool (*wanted)(const StepEvents&);
};

/// A step with several events counts with each of them.
const StepKind step_kinds[] = {
    {"all", [](const StepEvents&) { return true; }},
    {"without a commit", [](const StepEvents& e) { return !e.commit; }},
    {"without any event", [](const StepEvents& e) { return !e.any(); }},
    {"with a commit", [](const StepEvents& e) { return e.commit; }},
    {"with an activation", [](const StepEvents& e) { return e.activation; }},
    {"with an activation but no commit", [](const StepEvents& e) { return e.activation && !e.commit; }},
    {"with an unforeseen activation", [](const StepEvents& e) { return e.unforeseen; }},
};

const char* passName(bool second) {
    return second ? "second" : "first";
}

TimeSummary summaryOf(const CompressedRun& run, bool second_pass, const StepKind& kind) {
    return summarise(run, [&](const CompressedStep& step) {
        return step.second_pass == second_pass && kind.wanted(step.events);
    });
}

TimeSummary summaryOf(const std::optional<FilledRun>& run) {
    return summarise(run ? run->times : std::vector<StepTime>{});
}

double seenIn(const std::optional<FilledRun>& run) {
    return run ? run->seen : std::numeric_limits<double>::quiet_NaN();
}

double megabytes(std::size_t bytes) {
    return 1e-6 * static_cast<double>(bytes);
}

double ratio(std::size_t bytes, std::size_t of) {
    return static_cast<double>(bytes) / static_cast<double>(of);
}

}  // namespace

TimeSummary summarise(const CompressedRun& run, const std::function<bool(const CompressedStep&)>& wanted) {
    std::vector<StepTime> times;
    for (const CompressedStep& step : run.steps)
        if (wanted(step)) times.push_back(step.time);
    return summarise(times);
}

std::vector<const CompressedRun*> compressedRuns(const Results& results) {
    std::vector<const CompressedRun*> runs;
    for (const SizeResult& size : results.sizes) runs.push_back(&size.compressed);
    for (const CompressedRun& run : results.roads) runs.push_back(&run);
    return runs;
}

study::Table timesTable(const Results& results) {
    study::Table table;
    table.columns = {numberColumn("landmarks", "landmarks"),
                     numberColumn("seen a step", "compressed_seen"),
                     numberColumn("compressed, median [ms]", "compressed_median_ms"),
                     numberColumn("mean [ms]", "compressed_mean_ms"),
                     numberColumn("99th percentile [ms]", "compressed_p99_ms"),
                     numberColumn("dense, median [ms]", "dense_median_ms"),
                     numberColumn("steps", "dense_steps"),
                     numberColumn("seen", "dense_seen"),
                     numberColumn("kf-slam, median [ms]", "kf_slam_median_ms"),
                     numberColumn("steps", "kf_slam_steps"),
                     numberColumn("seen", "kf_slam_seen"),
                     numberColumn("dense / compressed, medians", "dense_ratio"),
                     numberColumn("kf-slam / compressed, medians", "kf_slam_ratio"),
                     numberColumn("kf-slam / compressed, means", "kf_slam_mean_ratio")};
    for (const SizeResult& size : results.sizes) {
        const TimeSummary compressed = summaryOf(size.compressed, true, step_kinds[0]),
                          dense = summaryOf(size.dense), kf_slam = summaryOf(size.kf_slam);
        table.lines.push_back(
            {{countField(size.compressed.landmarks), numberField(size.compressed.seen),
              numberField(compressed.median), numberField(compressed.mean), numberField(compressed.p99),
              numberField(dense.median), countField(dense.steps), numberField(seenIn(size.dense)),
              numberField(kf_slam.median), countField(kf_slam.steps), numberField(seenIn(size.kf_slam)),
              numberField(dense.median / compressed.median), numberField(kf_slam.median / compressed.median),
              numberField(kf_slam.mean / compressed.mean)}});
    }
    return table;
}

study::Table passesTable(const Results& results) {
    study::Table table;
    table.columns = {textColumn("world", "world"),
                     numberColumn("landmarks", "landmarks"),
                     textColumn("pass", "pass"),
                     numberColumn("steps", "steps"),
                     numberColumn("commits", "commits"),
                     numberColumn("median [ms]", "median_ms"),
                     numberColumn("mean [ms]", "mean_ms"),
                     numberColumn("99 % without commits [ms]", "p99_without_commits_ms"),
                     numberColumn("99 % of all [ms]", "p99_ms"),
                     numberColumn("longest [ms]", "longest_ms"),
                     numberColumn("longest, wall [ms]", "longest_wall_ms")};
    for (const CompressedRun* run : compressedRuns(results))
        for (const bool second : {false, true}) {
            const TimeSummary all = summaryOf(*run, second, step_kinds[0]),
                              without = summaryOf(*run, second, step_kinds[1]),
                              commits = summaryOf(*run, second, step_kinds[3]);
            table.lines.push_back(
                {{textField(nameOf(run->layout)), countField(run->landmarks), textField(passName(second)),
                  countField(all.steps), countField(commits.steps), numberField(all.median),
                  numberField(all.mean), numberField(without.p99), numberField(all.p99),
                  numberField(all.longest), numberField(all.wall_longest)}});
        }
    return table;
}

study::Table stepsTable(const Results& results) {
    study::Table table;
    table.columns = {textColumn("world", "world"),
                     numberColumn("landmarks", "landmarks"),
                     textColumn("pass", "pass"),
                     textColumn("steps", "steps_of"),
                     numberColumn("number", "steps"),
                     numberColumn("median [ms]", "median_ms"),
                     numberColumn("99th percentile [ms]", "p99_ms"),
                     numberColumn("longest [ms]", "longest_ms"),
                     numberColumn("longest, wall [ms]", "longest_wall_ms")};
    std::vector<const CompressedRun*> largest{&results.sizes.back().compressed};
    if (!results.roads.empty()) largest.push_back(&results.roads.back());
    for (const CompressedRun* run : largest)
        for (const bool second : {false, true})
            for (const StepKind& kind : step_kinds) {
                const TimeSummary times = summaryOf(*run, second, kind);
                table.lines.push_back(
                    {{textField(nameOf(run->layout)), countField(run->landmarks), textField(passName(second)),
                      textField(kind.name), countField(times.steps), numberField(times.median),
                      numberField(times.p99), numberField(times.longest), numberField(times.wall_longest)}});
            }
    return table;
}

study::Table pacedTable(const Results& results) {
    study::Table table;
    table.columns = {textColumn("world", "world"),
                     numberColumn("landmarks", "landmarks"),
                     numberColumn("rate [Hz]", "rate_hz"),
                     textColumn("pass", "pass"),
                     textColumn("steps", "steps_of"),
                     numberColumn("number", "steps"),
                     numberColumn("wall: median [ms]", "wall_median_ms"),
                     numberColumn("99th percentile [ms]", "wall_p99_ms"),
                     numberColumn("longest [ms]", "wall_longest_ms"),
                     numberColumn("the step's thread: median [ms]", "median_ms"),
                     numberColumn("99th percentile [ms]", "p99_ms"),
                     numberColumn("longest [ms]", "longest_ms"),
                     numberColumn("mean [ms]", "mean_ms"),
                     numberColumn("the other thread: mean [ms]", "background_ms")};
    for (const CompressedRun& run : results.paced)
        for (const bool second : {false, true})
            for (const StepKind& kind : step_kinds) {
                const TimeSummary times = summaryOf(run, second, kind);
                const bool all = &kind == &step_kinds[0];
                table.lines.push_back(
                    {{textField(nameOf(run.layout)), countField(run.landmarks), numberField(run.pace.rate),
                      textField(passName(second)), textField(kind.name), countField(times.steps),
                      numberField(times.wall_median), numberField(times.wall_p99),
                      numberField(times.wall_longest), numberField(times.median), numberField(times.p99),
                      numberField(times.longest), numberField(times.mean),
                      numberField(all ? (second ? run.background_second : run.background_first)
                                      : std::numeric_limits<double>::quiet_NaN())}});
            }
    return table;
}

study::Table memoryTable(const Results& results) {
    study::Table table;
    table.columns = {numberColumn("landmarks", "landmarks"),
                     textColumn("run", "run"),
                     numberColumn("modes", "modes"),
                     numberColumn("joint state [MB]", "state_mb"),
                     numberColumn("process grew by [MB]", "resident_mb"),
                     numberColumn("one full covariance [MB]", "covariance_mb"),
                     numberColumn("joint state / full", "state_ratio"),
                     numberColumn("process / full", "resident_ratio")};
    const auto add = [&](int landmarks, const std::string& run, int modes, const MemoryUse& use) {
        const std::size_t full = covarianceBytes(landmarks);
        table.lines.push_back(
            {{countField(landmarks), textField(run), countField(modes), numberField(megabytes(use.state)),
              numberField(megabytes(use.resident)), numberField(megabytes(full)),
              numberField(ratio(use.state, full)), numberField(ratio(use.resident, full))}});
    };
    for (const SizeResult& size : results.sizes)
        add(size.compressed.landmarks, "ekf_slamot, twice", 1, size.compressed.memory);
    for (const ModesResult& modes : results.modes)
        add(modes.landmarks, "imm_slamot, once, steps of 1 m", modes.modes, modes.memory);
    return table;
}

study::Table moversTable(const Results& results) {
    study::Table table;
    table.columns = {textColumn("engine", "engine"),
                     numberColumn("movers", "movers"),
                     numberColumn("landmarks", "landmarks"),
                     numberColumn("dimensions", "dimensions"),
                     numberColumn("steps", "steps"),
                     numberColumn("median [ms]", "median_ms"),
                     numberColumn("99th percentile [ms]", "p99_ms"),
                     numberColumn("longest [ms]", "longest_ms"),
                     numberColumn("rate by the mean [Hz]", "mean_hz"),
                     numberColumn("by the longest [Hz]", "least_hz")};
    for (const MoversResult& result : results.movers) {
        const TimeSummary times = summarise(result.run.times);
        table.lines.push_back(
            {{textField(result.engine), countField(result.movers), countField(result.landmarks),
              countField(result.run.dimension), countField(times.steps), numberField(times.median),
              numberField(times.p99), numberField(times.longest), numberField(1e3 / times.mean),
              numberField(1e3 / times.longest)}});
    }
    return table;
}

study::Table allTimesTable(const Results& results) {
    study::Table table;
    for (const char* name : {"world", "landmarks", "program", "pass", "steps_of", "seen", "steps", "mean_ms",
                             "median_ms", "p99_ms", "longest_ms", "wall_median_ms", "wall_longest_ms"})
        table.columns.push_back(textColumn(name, name));
    const auto add = [&](WorldLayout world, int landmarks, const std::string& program,
                         const std::string& pass, const std::string& kind, double seen,
                         const TimeSummary& t) {
        table.lines.push_back(
            {{textField(nameOf(world)), countField(landmarks), textField(program), textField(pass),
              textField(kind), numberField(seen), countField(t.steps), numberField(t.mean),
              numberField(t.median), numberField(t.p99), numberField(t.longest), numberField(t.wall_median),
              numberField(t.wall_longest)}});
    };
    for (const CompressedRun* run : compressedRuns(results))
        for (const bool second : {false, true})
            for (const StepKind& kind : step_kinds)
                add(run->layout, run->landmarks, "compressed", passName(second), kind.name, run->seen,
                    summaryOf(*run, second, kind));
    const auto addFilled = [&](int landmarks, const std::string& program,
                               const std::optional<FilledRun>& run) {
        if (run) add(WorldLayout::field, landmarks, program, "", "all", run->seen, summarise(run->times));
    };
    for (const SizeResult& size : results.sizes) {
        addFilled(size.compressed.landmarks, "dense", size.dense);
        addFilled(size.compressed.landmarks, "kf-slam", size.kf_slam);
    }
    return table;
}

}  // namespace slamot::bench

// map_size_bench: the time and the memory of a step against the size of the map, for the two engines of the
// joint state and MRPT's kf-slam, in one run. doc/results/map_size.md is filled by it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>

#include "BenchPage.h"
#include "Machine.h"
#include "MapSizeChecks.h"
#include "MapSizeReport.h"
#include "slamot/core/config/Config.h"

namespace slamot::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::vector<int> sizes{50, 100, 200, 400, 800, 1600, 4000, 10000};
    double step = 0.1;  ///< [m]
    double rate = 0;    ///< [Hz] of the runs at a sensor's rate; 0: none
    bool only_paced = false;
    bool quick = false;
    std::string out = "map_size", page;
};

constexpr int kf_slam_to = 1600;  // a step of kf-slam takes the cube of the map
constexpr int road_too = 1600;    // beside the largest size
constexpr int modes_from = 1000;  // in smaller maps most landmarks are active: nothing to compress
constexpr int movers = 50, movers_landmarks = 1000;

void say(const std::string& text) {
    std::cerr << text << std::endl;
}

void sayTimes(const char* program, const std::vector<StepTime>& times, double end_error) {
    const TimeSummary t = summarise(times);
    say(fmt::format(
        "  {}: {} steps, median {:.3g} ms, 99 % {:.3g} ms, longest {:.3g} ms; position {:.2g} m off", program,
        t.steps, t.median, t.p99, t.longest, end_error));
}

CompressedRun measureCompressed(WorldLayout world, int landmarks, double step, const Pace& pace = {}) {
    say(fmt::format("{}, {} landmarks{}", nameOf(world), landmarks,
                    pace.rate > 0 ? fmt::format(", two threads, {} Hz", pace.rate) : ""));
    CompressedRun run = runCompressed(world, landmarks, step, pace);
    std::vector<StepTime> times;
    for (const CompressedStep& each : run.steps) times.push_back(each.time);
    sayTimes("compressed", times, run.end_error);
    return run;
}

SizeResult measureField(int landmarks, double step, const Patience& patience) {
    SizeResult result{measureCompressed(WorldLayout::field, landmarks, step), {}, {}};
    if (denseBytes(landmarks) > availableMemory()) {
        say(fmt::format("  dense: left out, it may need {} MB and {} MB are available",
                        denseBytes(landmarks) / 1000000, availableMemory() / 1000000));
    } else {
        result.dense = runDense(landmarks, step, patience);
        sayTimes("dense", result.dense->times, result.dense->end_error);
    }
    if (landmarks <= kf_slam_to) {
        result.kf_slam = runKfSlam(landmarks, step, patience);
        sayTimes("kf-slam", result.kf_slam->times, result.kf_slam->end_error);
    }
    return result;
}

/// Of sizes by rising size.
std::vector<int> roadSizes(const std::vector<int>& sizes) {
    std::vector<int> out;
    for (const int landmarks : sizes)
        if (landmarks == road_too || landmarks == sizes.back()) out.push_back(landmarks);
    return out;
}

/// The largest map of each world.
std::vector<CompressedRun> measurePaced(const Options& options) {
    std::vector<CompressedRun> out;
    for (const WorldLayout world : {WorldLayout::field, WorldLayout::road})
        if (options.rate > 0)
            out.push_back(measureCompressed(world, options.sizes.back(), options.step, {options.rate, true}));
    return out;
}

Results measureAll(const Options& options) {
    const Patience patience = options.quick ? Patience{10, 10} : Patience{};
    Results results;
    results.paced = measurePaced(options);
    for (const int landmarks : options.sizes)
        results.sizes.push_back(measureField(landmarks, options.step, patience));
    for (const int landmarks : roadSizes(options.sizes))
        results.roads.push_back(measureCompressed(WorldLayout::road, landmarks, options.step));
    for (const int landmarks : options.sizes)
        for (int modes = 1; modes <= 3 && landmarks >= modes_from; ++modes) {
            say(fmt::format("memory of {} landmarks with {} modes", landmarks, modes));
            results.modes.push_back({landmarks, modes, runModes(landmarks, modes)});
        }
    for (const auto& [name, engine] :
         {std::pair("compressed", JointEngine::Kind::compressed), {"dense", JointEngine::Kind::dense}}) {
        say(fmt::format("{} movers and {} landmarks, {}", movers, movers_landmarks, name));
        results.movers.push_back(
            {name, movers, movers_landmarks,
             runMovers(engine, movers, movers_landmarks, options.step, {300, patience.seconds})});
    }
    return results;
}

PageContents contents(const Results& results, const std::string& stamp, const std::string& figure) {
    return {{"stamp", stamp},
            {"table checks", toMarkdown(checksTable(results))},
            {"table times", toMarkdown(timesTable(results))},
            {"table passes", toMarkdown(passesTable(results))},
            {"table steps", toMarkdown(stepsTable(results))},
            {"table paced", toMarkdown(pacedTable(results))},
            {"table memory", toMarkdown(memoryTable(results))},
            {"table movers", toMarkdown(moversTable(results))},
            {"figure", fmt::format("![Time of a step and memory by map size]({}.svg)\n", figure)}};
}

void writePaced(const Results& results, const fs::path& folder) {
    if (!results.paced.empty())
        writeFile((folder / "map_size_paced.csv").string(), toCsv(pacedTable(results)));
}

void write(const Results& results, const std::string& stamp, const fs::path& folder) {
    std::string text;
    for (const auto& [mark, content] : contents(results, stamp, "map_size"))
        text += fmt::format("`{}`\n\n{}\n", mark, content);
    writeFile((folder / "map_size.md").string(), text);
    writeFile((folder / "map_size.csv").string(), toCsv(allTimesTable(results)));
    writePaced(results, folder);
    writeFile((folder / "map_size_memory.csv").string(), toCsv(memoryTable(results)));
    writeFile((folder / "map_size_movers.csv").string(), toCsv(moversTable(results)));
    drawSvg(mapSizeFigure(results), folder / "map_size");
}

void fill(const Results& results, const std::string& stamp, const fs::path& page) {
    drawSvg(mapSizeFigure(results), page.parent_path() / page.stem());
    fillPage(page.string(), "map_size", contents(results, stamp, page.stem().string()));
}

void run(Options options, const std::string& command) {
    if (options.quick)
        options.sizes.erase(std::remove_if(options.sizes.begin(), options.sizes.end(),
                                           [](int landmarks) { return landmarks > kf_slam_to; }),
                            options.sizes.end());
    if (options.sizes.empty())
        throw ConfigError(fmt::format("--quick leaves no size, expected one of at most {}", kf_slam_to));
    std::sort(options.sizes.begin(), options.sizes.end());
    fs::create_directories(options.out);
    if (!options.page.empty()) options.page = fs::canonical(options.page).string();
    const OtherLoad others;
    if (options.only_paced) {
        Results results;
        results.paced = measurePaced(options);
        writePaced(results, options.out);
        std::cout << fmt::format("Others used {:.1f} % of the machine.\n\n", 100 * others.part())
                  << toMarkdown(pacedTable(results));
        return;
    }
    const Results results = measureAll(options);
    const std::string stamp = stampLine(command, others.part());
    write(results, stamp, options.out);
    if (!options.page.empty()) fill(results, stamp, options.page);
    std::cout << toMarkdown(checksTable(results));
}

}  // namespace
}  // namespace slamot::bench

int main(int argc, char** argv) {
    slamot::bench::Options options;
    CLI::App app("Time and memory of a step against the size of the map.");
    app.add_option("--sizes", options.sizes, "Landmarks, separated by commas")
        ->delimiter(',')
        ->check(CLI::Range(50, 20000));
    app.add_option("--step", options.step, "Metres between scans")->check(CLI::Range(0.01, 2.0));
    app.add_option(
           "--rate", options.rate,
           "Hz; the largest map of each world once more, on two threads, with steps that come at this rate")
        ->check(CLI::Range(1.0, 1000.0));
    app.add_flag("--quick", options.quick, "Sizes to 1600 only, a few steps of dense and kf-slam");
    app.add_option("--out", options.out, "Folder of map_size.csv, .md and .svg");
    app.add_option("--fill", options.page, "Page whose marks `<!-- bench map_size ... -->` are filled");
    app.add_flag("--only-rate", options.only_paced, "Nothing but the runs of --rate")
        ->needs("--rate")
        ->excludes("--fill");
    CLI11_PARSE(app, argc, argv);
    try {
        slamot::bench::run(options, fmt::format("{}", fmt::join(argv, argv + argc, " ")));
    } catch (const std::exception& error) {
        std::cerr << "map_size_bench: " << error.what() << "\n";
        return 1;
    }
}

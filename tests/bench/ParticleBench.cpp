// particle_bench: the step time and error of the particle filters on a world like RFS-SLAM's, and how time
// and memory grow with particles and landmarks. doc/results/particles.md is filled by it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <limits>

#include "BenchPage.h"
#include "Machine.h"
#include "ParticleRuns.h"
#include "TableFields.h"

namespace slamot::bench {
namespace {

namespace fs = std::filesystem;

/// What RFS-SLAM's two programs take for a step of their own world [ms], 0 unknown. It is no Debian package: they are
/// run by hand on the same machine just before.
struct Peers {
    double fastslam = 0, rb_phd = 0;
};

struct Options {
    int seeds = 5;
    Peers peers;
    std::vector<int> particles{10, 30, 100, 300, 1000}, landmarks{50, 200, 800, 3200, 10000};
    bool only_world = false;
    std::string out = "particles", page;
};

std::vector<Contender> contenders() {
    const std::string life = "clutter_per_scan = 0.01\ndetection_probability = 0.99\n";
    const auto fast = [&](const std::string& version) {
        return "[fastslam]\nparticles = 200\nversion = " + version + "\n[fastslam.landmarks]\n" + life;
    };
    const std::string phd = "[gmphd_ufastslam]\nparticles = 200\n[gmphd_ufastslam.map]\n" + life;
    const std::string bernoulli = "[pmb_ufastslam]\nparticles = 200\n[pmb_ufastslam.landmarks]\n" + life;
    const std::string unscented = "[ufastslam]\nparticles = 200\n[ufastslam.landmarks]\n" + life;
    return {{"FastSLAM 1.0, identities known", "fastslam", true, fast("1")},
            {"FastSLAM 1.0", "fastslam", false, fast("1")},
            {"FastSLAM 2.0, identities known", "fastslam", true, fast("2")},
            {"FastSLAM 2.0", "fastslam", false, fast("2")},
            {"UFastSLAM, identities known", "ufastslam", true, unscented},
            {"UFastSLAM", "ufastslam", false, unscented},
            {"GM-PHD-UFastSLAM", "gmphd_ufastslam", false, phd},
            {"PMB-UFastSLAM", "pmb_ufastslam", false, bernoulli}};
}

/// How many times faster than the program that does the same; not a number where there is none.
double timesFaster(const Contender& contender, const Peers& peers, double milliseconds) {
    double peer = 0;
    if (contender.label == "FastSLAM 1.0") peer = peers.fastslam;
    if (contender.plugin == "gmphd_ufastslam") peer = peers.rb_phd;
    return peer > 0 ? peer / milliseconds : std::numeric_limits<double>::quiet_NaN();
}

struct WorldResult {
    Contender contender;
    TimeSummary times;
    double rmse, landmarks, faster;
};

struct Results {
    std::vector<WorldResult> world;
    std::vector<ScaleRun> by_particles, by_landmarks;
};

WorldResult measure(const Contender& contender, int seeds, const Peers& peers) {
    std::vector<StepTime> times;
    double rmse = 0, landmarks = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const WorldRun run = runWorld(contender, static_cast<std::uint64_t>(seed));
        times.insert(times.end(), run.times.begin(), run.times.end());
        rmse += run.rmse / seeds;
        landmarks += run.final_landmarks / seeds;
    }
    const TimeSummary summary = summarise(times);
    std::cerr << fmt::format("{}: {:.3f} ms a step, {:.3f} m, {:.1f} landmarks\n", contender.label,
                             summary.mean, rmse, landmarks);
    return {contender, summary, rmse, landmarks, timesFaster(contender, peers, summary.mean)};
}

ScaleRun measureScale(int particles, int landmarks) {
    ScaleRun run = runScale(particles, landmarks);
    std::cerr << fmt::format("{} particles, {} landmarks: {:.3g} ms, {:.3g} MB, {:.2g} m off at the end\n",
                             particles, landmarks, summarise(run.times).median,
                             1e-6 * static_cast<double>(run.resident), run.end_error);
    return run;
}

study::Table worldTable(const std::vector<WorldResult>& results) {
    study::Table table;
    table.columns = {textColumn("Estimator", "estimator"),    numberColumn("Mean, ms", "mean_ms"),
                     numberColumn("Median", "median_ms"),     numberColumn("99 %", "p99_ms"),
                     numberColumn("Robot RMSE, m", "rmse_m"), numberColumn("Landmarks", "landmarks"),
                     numberColumn("Times faster", "faster")};
    for (const WorldResult& r : results)
        table.lines.push_back({{textField(r.contender.label), numberField(r.times.mean),
                                numberField(r.times.median), numberField(r.times.p99), numberField(r.rmse),
                                numberField(r.landmarks), numberField(r.faster)}});
    return table;
}

study::Table scaleTable(const std::vector<ScaleRun>& runs) {
    study::Table table;
    table.columns = {numberColumn("Particles", "particles"),
                     numberColumn("Landmarks", "landmarks"),
                     numberColumn("Seen a step", "seen"),
                     numberColumn("Median, ms", "median_ms"),
                     numberColumn("99 %", "p99_ms"),
                     numberColumn("Memory, MB", "memory_mb"),
                     numberColumn("Off at the end, m", "end_error_m")};
    for (const ScaleRun& run : runs) {
        const TimeSummary times = summarise(run.times);
        table.lines.push_back(
            {{countField(run.particles), countField(run.landmarks), numberField(run.seen),
              numberField(times.median), numberField(times.p99),
              numberField(1e-6 * static_cast<double>(run.resident)), numberField(run.end_error)}});
    }
    return table;
}

template <class X, class Y>
report::Points2 curve(const std::vector<ScaleRun>& runs, const X& x, const Y& y) {
    report::Points2 points;
    for (const ScaleRun& run : runs) points.emplace_back(x(run), y(run));
    return points;
}

report::Figure scaleFigure(const Results& results) {
    namespace colour = report::colour;
    const auto median = [](const ScaleRun& run) { return summarise(run.times).median; };
    const auto memory = [](const ScaleRun& run) { return 1e-6 * static_cast<double>(run.resident); };
    const auto particles = [](const ScaleRun& run) { return double(run.particles); };
    const auto landmarks = [](const ScaleRun& run) { return double(run.landmarks); };
    report::Figure figure;
    figure.columns = 2;
    const auto add = [&](const std::vector<ScaleRun>& runs, const auto& x, const std::string& over,
                         const std::string& note) {
        report::Panel time = logarithmicPanel(over, "Processor time of a step", "ms");
        addCurve(time, "median", curve(runs, x, median), colour::blue);
        addCurve(time, "99th percentile",
                 curve(runs, x, [](const ScaleRun& run) { return summarise(run.times).p99; }), colour::blue,
                 report::Dash::dashed);
        time.note = note;
        report::Panel bytes = logarithmicPanel(over, "Memory of the process", "MB");
        addCurve(bytes, "growth at its peak", curve(runs, x, memory), colour::vermillion);
        figure.panels.push_back(time);
        figure.panels.push_back(bytes);
    };
    add(results.by_particles, particles, "Particles",
        fmt::format("{} landmarks", results.by_particles.front().landmarks));
    add(results.by_landmarks, landmarks, "Landmarks in the map",
        fmt::format("{} particles", results.by_landmarks.front().particles));
    return figure;
}

Results measureAll(const Options& options) {
    Results results;
    for (const Contender& contender : contenders())
        results.world.push_back(measure(contender, options.seeds, options.peers));
    if (options.only_world) return results;
    for (const int particles : options.particles)
        results.by_particles.push_back(measureScale(particles, 800));
    for (const int landmarks : options.landmarks)
        results.by_landmarks.push_back(measureScale(100, landmarks));
    return results;
}

void run(const Options& options, const std::string& command) {
    fs::create_directories(options.out);
    const OtherLoad others;
    const Results results = measureAll(options);
    const std::string stamp = stampLine(command, others.part());
    std::cout << stamp << toMarkdown(worldTable(results.world));
    writeFile(options.out + "/particles_world.csv", toCsv(worldTable(results.world)));
    if (options.only_world) return;
    writeFile(options.out + "/particles_by_number.csv", toCsv(scaleTable(results.by_particles)));
    writeFile(options.out + "/particles_by_map.csv", toCsv(scaleTable(results.by_landmarks)));
    if (options.page.empty()) return;
    const fs::path page = fs::canonical(options.page);
    drawSvg(scaleFigure(results), page.parent_path() / page.stem());
    fillPage(page.string(), "particles",
             {{"stamp", stamp},
              {"table world", toMarkdown(worldTable(results.world))},
              {"table particles", toMarkdown(scaleTable(results.by_particles))},
              {"table landmarks", toMarkdown(scaleTable(results.by_landmarks))},
              {"figure", fmt::format("![Time of a step and memory by particles and landmarks]({}.svg)\n",
                                     page.stem().string())}});
}

}  // namespace
}  // namespace slamot::bench

int main(int argc, char** argv) {
    slamot::bench::Options options;
    CLI::App app("Time, memory and error of the particle filters.");
    app.add_option("--seeds", options.seeds, "Runs of each estimator")->check(CLI::Range(1, 1000));
    app.add_option("--peer-fastslam", options.peers.fastslam,
                   "What RFS-SLAM's fastslam2dSim takes a step, ms");
    app.add_option("--peer-rb-phd", options.peers.rb_phd, "What RFS-SLAM's rbphdslam2dSim takes a step, ms");
    app.add_option("--particles", options.particles, "Numbers of particles, separated by commas")
        ->delimiter(',');
    app.add_option("--landmarks", options.landmarks, "Numbers of landmarks, separated by commas")
        ->delimiter(',');
    app.add_option("--out", options.out, "Folder of the tables");
    app.add_option("--fill", options.page, "Page whose marks `<!-- bench particles ... -->` are filled");
    app.add_flag("--only-world", options.only_world, "Nothing but the world like RFS-SLAM's")
        ->excludes("--fill");
    CLI11_PARSE(app, argc, argv);
    try {
        slamot::bench::run(options, fmt::format("{}", fmt::join(argv, argv + argc, " ")));
    } catch (const std::exception& error) {
        std::cerr << "particle_bench: " << error.what() << "\n";
        return 1;
    }
}

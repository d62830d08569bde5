#include "MapSizeChecks.h"

#include <algorithm>

#include "TableFields.h"

namespace slamot::bench {
namespace {

const SizeResult* sizeOf(const Results& results, int landmarks) {
    const auto found = std::find_if(results.sizes.begin(), results.sizes.end(), [&](const SizeResult& size) {
        return size.compressed.landmarks == landmarks;
    });
    return found == results.sizes.end() ? nullptr : &*found;
}

bool ofSecondPass(const CompressedStep& step) {
    return step.second_pass;
}

class Checks {
  public:
    Checks() {
        table_.columns = {textColumn("demand", "demand"), textColumn("limit", "limit"),
                          numberColumn("measured", "measured"), textColumn("met", "met")};
    }

    void atMost(double limit, const std::string& unit, const std::string& demand,
                const std::optional<double>& measured) {
        add(demand, fmt::format("at most {}{}", limit, unit), measured, measured && *measured <= limit);
    }
    void atLeast(double limit, const std::string& unit, const std::string& demand,
                 const std::optional<double>& measured) {
        add(demand, fmt::format("at least {}{}", limit, unit), measured, measured && *measured >= limit);
    }
    const study::Table& table() const { return table_; }

  private:
    void add(const std::string& demand, const std::string& limit, const std::optional<double>& measured,
             bool met) {
        const study::Field value = measured ? numberField(*measured) : study::Field{"not run", {""}};
        table_.lines.push_back({{textField(demand), textField(limit), value,
                                 textField(!measured ? "–"
                                           : met     ? "yes"
                                                     : "no")}});
    }

    study::Table table_;
};

std::optional<double> ratioToKfSlam(const Results& results, int landmarks) {
    const SizeResult* size = sizeOf(results, landmarks);
    if (!size || !size->kf_slam) return std::nullopt;
    return summarise(size->kf_slam->times).mean / summarise(size->compressed, ofSecondPass).mean;
}

}  // namespace

study::Table checksTable(const Results& results) {
    constexpr int largest = 10000;
    Checks checks;
    for (const int landmarks : {800, 1600})
        checks.atLeast(200, "", fmt::format("{} landmarks: kf-slam's mean step / compressed", landmarks),
                       ratioToKfSlam(results, landmarks));

    const auto runs = compressedRuns(results);
    for (const WorldLayout world : {WorldLayout::field, WorldLayout::road}) {
        const auto run = std::find_if(runs.begin(), runs.end(), [&](const CompressedRun* each) {
            return each->layout == world && each->landmarks == largest;
        });
        std::optional<double> without_commit, longest;
        if (run != runs.end()) {
            without_commit = summarise(**run, [](const auto& step) { return !step.events.commit; }).p99;
            longest = summarise(**run, [](const auto&) { return true; }).longest;
        }
        const std::string what = fmt::format("10,000 landmarks, {}, one thread: ", nameOf(world));
        checks.atMost(1, " ms", what + "99th percentile of steps without a commit", without_commit);
        checks.atMost(50, " ms", what + "longest step", longest);
    }
    for (const CompressedRun& run : results.paced) {
        const std::string what = fmt::format("{} landmarks, {}, two threads, {} Hz, wall: ", run.landmarks,
                                             nameOf(run.layout), run.pace.rate);
        checks.atMost(1, " ms", what + "99th percentile of steps without a commit",
                      summarise(run, [](const auto& step) { return !step.events.commit; }).wall_p99);
        checks.atMost(50, " ms", what + "longest step",
                      summarise(run, [](const auto&) { return true; }).wall_longest);
    }

    for (int modes = 1; modes <= 3; ++modes) {
        const auto found = std::find_if(
            results.modes.begin(), results.modes.end(),
            [&](const ModesResult& result) { return result.landmarks == largest && result.modes == modes; });
        std::optional<double> part;
        if (found != results.modes.end())
            part = static_cast<double>(found->memory.state) / static_cast<double>(covarianceBytes(largest));
        checks.atMost(1.2, "",
                      fmt::format("10,000 landmarks, {} {}: joint state / one full covariance", modes,
                                  modes == 1 ? "mode" : "modes"),
                      part);
    }

    for (const MoversResult& movers : results.movers) {
        const TimeSummary times = summarise(movers.run.times);
        const std::string what =
            fmt::format("{} movers, {} landmarks, {}", movers.movers, movers.landmarks, movers.engine);
        checks.atLeast(10, " Hz", what + ": rate by the mean step", 1e3 / times.mean);
        checks.atLeast(10, " Hz", what + ": rate by the longest step", 1e3 / times.longest);
    }
    return checks.table();
}

}  // namespace slamot::bench

#include "slamot/study/Runner.h"

#include <mrpt/rtti/CObject.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_pipeline.h>

#include <chrono>
#include <cmath>
#include <mutex>

#include "slamot/core/threads/HandOver.h"

namespace slamot::study {

bool Shard::has(const WorldPlan& world) const {
    const std::size_t turn =
        static_cast<std::size_t>(world.replicate - 1) + world.source + world.scenario_point;
    return turn % static_cast<std::size_t>(count) == static_cast<std::size_t>(number - 1);
}

std::vector<Unit> unitsOf(const Plan& plan, const std::set<RunIndex>& done, const Shard& shard) {
    std::vector<Unit> units;
    for (std::size_t w = 0; w < plan.worlds.size(); ++w) {
        const WorldPlan& world = plan.worlds[w];
        if (!shard.has(world)) continue;
        Unit unit;
        unit.world = w;
        const std::size_t runs = plan.runsOf(world).size();
        for (std::size_t r = 0; r < runs; ++r)
            if (done.empty() || !done.count({w, r})) unit.runs.push_back(r);
        if (plan.kinds[world.kind].scenario) {
            if (!unit.runs.empty()) units.push_back(std::move(unit));
        } else {
            for (const std::size_t r : unit.runs) units.push_back({w, {r}});
        }
    }
    return units;
}

RowCounter::RowCounter(const std::vector<Unit>& units, std::function<void(const StudyProgress&)> tell,
                       std::function<void(const Row&)> take)
    : tell_(std::move(tell)), take_(std::move(take)) {
    for (const Unit& unit : units) progress_.total += unit.runs.size();
}

void RowCounter::operator()(const std::vector<Row>& rows) {
    for (const Row& row : rows) {
        take_(row);
        ++progress_.done;
        progress_.failed += row.status == "failed";
        for (const double part : {row.cost.wall_s, row.cost.simulate_s})
            if (std::isfinite(part)) runs_s_ += part;
    }
    if (tell_) tell_(progress_);
}

StudyTimes runStudy(const Plan& plan, const std::vector<Unit>& units, const PluginRegistry& registry,
                    const RunnerOptions& options, const std::function<void(const Row&)>& take) {
    const auto begin = std::chrono::steady_clock::now();
    const auto stopped = [&] { return options.unit.stop && options.unit.stop->load(); };
    UnitOptions unit_options = options.unit;
    unit_options.measure_memory = options.unit.measure_memory && options.threads == 1;
    RowCounter count(units, options.progress, take);
    std::size_t next = 0;
    if (options.threads == 1) {
        for (; next < units.size() && !stopped(); ++next)
            count(runUnit(plan, units[next], registry, unit_options));
    } else {
        // MRPT looks its classes up without a lock while none is being registered. Those of the libraries
        // were registered when they were loaded, those of the plugins when the study was laid out, which
        // loads all it needs; what may be pending is done here, so that none comes while threads read logs.
        mrpt::rtti::registerAllPendingClasses();
        namespace tbb = oneapi::tbb;
        const auto threads = static_cast<std::size_t>(options.threads);
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto hand_out = [&](tbb::flow_control& flow) {
            const HandOver here;
            if (next == units.size() || stopped()) flow.stop();
            return next < units.size() ? next++ : next;
        };
        std::mutex taking;
        const auto run_and_take = [&](std::size_t unit) {
            const HandOver here;
            const std::vector<Row> rows = runUnit(plan, units[unit], registry, unit_options);
            const std::lock_guard one_at_a_time(taking);
            count(rows);
        };
        const HandOver around;
        tbb::parallel_pipeline(
            threads, tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, hand_out) &
                         tbb::make_filter<std::size_t, void>(tbb::filter_mode::parallel, run_and_take));
    }
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return {wall, count.runsSeconds()};
}

}  // namespace slamot::study

#include "Ranks.h"

#include <fmt/format.h>

#include <boost/mpi/collectives.hpp>
#include <boost/mpi/environment.hpp>
#include <boost/mpi/status.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>
#include <chrono>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "slamot/rawlog/Sha256.h"
#include "slamot/study/Row.h"

namespace slamot::study {
namespace {

namespace mpi = boost::mpi;
using Bytes = std::vector<std::uint8_t>;

/// A unit is its world and its runs; an empty message ends the work. Rows go back as CBOR.
enum Tag { unit_tag = 1, rows_tag };

/// MPI's own waiting keeps a core busy, which the rank beside it may need.
mpi::status waitFor(const mpi::communicator& world, int source, int tag) {
    for (;;) {
        if (const auto arrived = world.iprobe(source, tag)) return *arrived;
        std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
}

void send(const mpi::communicator& world, int rank, const Unit* unit) {
    std::vector<std::size_t> message;
    if (unit) {
        message = unit->runs;
        message.insert(message.begin(), unit->world);
    }
    world.send(rank, unit_tag, message);
}

std::vector<Row> receiveRows(const mpi::communicator& world, int rank) {
    Bytes bytes;
    world.recv(rank, rows_tag, bytes);
    std::vector<Row> rows;
    for (const nlohmann::json& row : nlohmann::json::from_cbor(bytes)) rows.push_back(rowFromJson(row));
    return rows;
}

}  // namespace

StudyTimes handOut(const mpi::communicator& world, const Plan& plan, const std::vector<Unit>& units,
                   const std::atomic<bool>& stop, const std::function<void(const StudyProgress&)>& progress,
                   const std::function<void(const Row&)>& take) {
    requireSamePlan(world, plan);
    const auto begin = std::chrono::steady_clock::now();
    RowCounter count(units, progress, take);
    std::deque<Unit> waiting(units.begin(), units.end());
    std::map<int, Unit> working;
    // Ranks without work are told the end last: a rank that stops gives work back.
    std::set<int> idle;
    for (int rank = 1; rank < world.size(); ++rank) idle.insert(rank);
    const auto handOutWaiting = [&] {
        while (!stop && !waiting.empty() && !idle.empty()) {
            const int rank = *idle.begin();
            send(world, rank, &waiting.front());
            working[rank] = std::move(waiting.front());
            waiting.pop_front();
            idle.erase(rank);
        }
    };
    handOutWaiting();
    while (!working.empty()) {
        const int rank = waitFor(world, mpi::any_source, rows_tag).source();
        const std::vector<Row> rows = receiveRows(world, rank);
        Unit unit = std::move(working.extract(rank).mapped());
        if (rows.size() < unit.runs.size()) {
            // Stopped from outside: it would answer all further units with nothing.
            send(world, rank, nullptr);
            unit.runs.erase(unit.runs.begin(), unit.runs.begin() + static_cast<std::ptrdiff_t>(rows.size()));
            waiting.push_front(std::move(unit));
        } else {
            idle.insert(rank);
        }
        // The next unit first: the rank need not wait for the store.
        handOutWaiting();
        count(rows);
    }
    for (const int rank : idle) send(world, rank, nullptr);
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
            count.runsSeconds()};
}

void work(const mpi::communicator& world, const Plan& plan, const PluginRegistry& registry,
          const std::atomic<bool>& stop) {
    requireSamePlan(world, plan);
    UnitOptions options;
    options.stop = &stop;
    options.measure_memory = true;
    for (;;) {
        waitFor(world, 0, unit_tag);
        std::vector<std::size_t> message;
        world.recv(0, unit_tag, message);
        if (message.empty()) return;
        const Unit unit{message.front(), {message.begin() + 1, message.end()}};
        nlohmann::json rows = nlohmann::json::array();
        for (const Row& row : runUnit(plan, unit, registry, options)) rows.push_back(toJson(row));
        world.send(0, rows_tag, nlohmann::json::to_cbor(rows));
    }
}

void requireSamePlan(const mpi::communicator& world, const Plan& plan) {
    Sha256 sum;
    // A kind's worlds differ in their seeds alone: the first and the last stand for those between.
    std::vector<std::string> texts = {std::to_string(plan.worlds.size())};
    for (const PlannedConfig& config : plan.configs) texts.push_back(config.build);
    for (std::size_t w = 0; w < plan.worlds.size(); ++w) {
        const bool first_or_last = w < plan.kinds.size() || w + plan.kinds.size() >= plan.worlds.size();
        if (!first_or_last) continue;
        for (const RunPlan& run : plan.runsOf(plan.worlds[w]))
            texts.push_back(plan.keyOf(plan.worlds[w], run));
    }
    for (const std::string& text : texts) sum.add(text.data(), text.size());
    const std::string own = sum.hex();
    std::string first = own;
    mpi::broadcast(world, first, 0);
    if (own != first)
        throw ConfigError(
            fmt::format("rank {} on {}: its study, program or plugins are not those of rank 0, expected the "
                        "same files everywhere",
                        world.rank(), mpi::environment::processor_name()));
}

}  // namespace slamot::study

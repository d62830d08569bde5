#pragma once
// Small studies in a folder of their own: worlds of 15 steps that take a few milliseconds a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/study/Runner.h"
#include "support/TemporaryFolder.h"

namespace slamot::study {

inline const PluginRegistry& registry() {
    static const PluginRegistry found = PluginRegistry::discover();
    return found;
}

class StudyFolder : public testing::Test {
  protected:
    const test::TemporaryFolder folder;

    StudyFolder() {
        folder.write(
            "field.ini",
            "[scenario]\ndt = 0.2\nsteps = 15\n"
            "[world]\nlandmarks = 12\nbox = -10,30,-20,20\n"
            "[robot]\ncontroller = constant\nspeed = 2\nmotion = steered\nwheelbase = 2\nspeed_std = 0.2\n"
            "[sensor.landmarks]\nmax_range = 25\nrange_std = 0.1\nbearing_std_deg = 1\n");
        folder.write("ekf.ini",
                     "[run]\nestimator = ekf_slamot\nseed = 77\n[motion]\nmodel = steered\nwheelbase = 2\n"
                     "[ekf_slamot]\nconsistency = invariant\n");
    }

    /// Two scenarios and two configs, as most tests want them.
    static std::string usual(const std::string& replicates = "3") {
        return "[study]\nseed = 4\nreplicates = " + replicates +
               "\nshort_replicates = 2\nseries = robot_nees, landmark_count\n"
               "[scenario.near]\nfile = field.ini\nsensor.landmarks.max_range = 15\n"
               "[scenario.far]\nfile = field.ini\n"
               "[config.classic]\nfile = ekf.ini\nekf_slamot.consistency = classic\n"
               "[config.invariant]\nfile = ekf.ini\n";
    }

    StudyFile load(const std::string& text, const std::string& name = "small") const {
        return loadStudy(folder.write(name + ".ini", text));
    }
    Plan plan(const std::string& text, PlanRequest request = {}) const {
        request.work_folder = folder.path("logs");
        return layOut(load(text), request, registry());
    }
    static std::vector<Row> run(const Plan& plan, const std::vector<Unit>& units,
                                const RunnerOptions& options = {}) {
        std::vector<Row> rows;
        runStudy(plan, units, registry(), options, [&](const Row& row) { rows.push_back(row); });
        return rows;
    }
    static std::vector<Row> run(const Plan& plan, const RunnerOptions& options = {}) {
        return run(plan, unitsOf(plan, {}, {}), options);
    }
    static std::set<std::string> identities(const std::vector<Row>& rows) {
        std::set<std::string> all;
        for (const Row& row : rows) all.insert(identity(row));
        return all;
    }
    static std::set<std::string> keysOf(const Plan& plan) {
        std::set<std::string> keys;
        for (const WorldPlan& world : plan.worlds)
            for (const RunPlan& one : plan.runsOf(world)) keys.insert(plan.keyOf(world, one));
        return keys;
    }
    static std::set<std::string> keysOf(const Plan& plan, const std::set<RunIndex>& runs) {
        std::set<std::string> keys;
        for (const auto& [w, r] : runs)
            keys.insert(plan.keyOf(plan.worlds[w], plan.runsOf(plan.worlds[w])[r]));
        return keys;
    }
};

}  // namespace slamot::study

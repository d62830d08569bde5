// The real log this program is judged by, MRCLAM set 6: each of the five robots maps the landmarks and tracks the
// others. The bounds are the project's aims; doc/results/mrclam.md has the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "slamot/rawlog/Importer.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/run/RunJob.h"
#include "support/TemporaryFolder.h"

namespace slamot {
namespace {

namespace fs = std::filesystem;

struct Averages {
    double rmse = 0, median_from_robot = 0;
};

class Mrclam : public testing::Test {
   protected:
    static void SetUpTestSuite() {
        const char* given = std::getenv("SLAMOT_DATASETS");
        const fs::path data = fs::path(given ? given : SLAMOT_SOURCE_DIR "/../shared/datasets") / "mrclam_6";
        if (!fs::is_directory(data)) return;
        temporary = std::make_unique<test::TemporaryFolder>();
        logs = temporary->path();
        const auto found = std::find_if(importers().begin(), importers().end(),
                                        [](const Importer& importer) { return importer.format == "mrclam"; });
        found->run(data.string(), logs.string(), [](double) { return true; });
    }

    static void TearDownTestSuite() { temporary.reset(); }

    void SetUp() override {
        if (logs.empty()) GTEST_SKIP() << "no mrclam_6 in SLAMOT_DATASETS or beside the project";
    }

    /// Means over the five robots, each alone.
    static Averages run(const std::string& core) {
        const PluginRegistry registry = PluginRegistry::discover();
        Averages mean;
        for (int robot = 1; robot <= 5; ++robot) {
            run::RunRequest request;
            request.config = Config::fromFile(SLAMOT_SOURCE_DIR "/config/runs/mrclam_ekf.ini");
            request.config.set("ekf_slamot", "consistency", core);
            request.config.set("output", "interval", "0");
            for (const char* file : {"innovations", "landmarks_history", "steps", "correlation", "map", "scene", "rawlog"})
                request.config.set("output", file, "false");
            request.log_file = (logs / ("robot_" + std::to_string(robot) + ".rawlog")).string();
            request.out_folder = (logs / "out").string();
            const Truth truth = readTruth(truthFolderOf(request.log_file));
            request.truth = &truth;
            const run::JobResult result = run::runLog(request, registry);
            const auto& metrics = result.summary["metrics"];
            mean.rmse += metrics["robot"]["position"]["rmse"].get<double>() / 5;
            mean.median_from_robot += metrics["targets"]["seen"]["relative_position"]["median"].get<double>() / 5;
        }
        return mean;
    }

    inline static std::unique_ptr<test::TemporaryFolder> temporary;
    inline static fs::path logs;
};

TEST_F(Mrclam, InvariantCoreReachesItsAimsOnRawOdometry) {
    const Averages invariant = run("invariant"), classic = run("classic");
    EXPECT_LE(invariant.rmse, 0.36);
    EXPECT_LE(invariant.rmse, 0.65 * classic.rmse);
    EXPECT_LE(invariant.median_from_robot, 0.10);
}

}  // namespace
}  // namespace slamot

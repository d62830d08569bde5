#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/study/Export.h"
#include "study/Builders.h"
#include "support/Expect.h"
#include "support/TemporaryFolder.h"

namespace slamot::study {
namespace export_test {

const char* const text = R"([table.errors]
kind = means
figures = robot.position.rmse
[figure.nees]
kind = bands
series = robot_nees
)";

std::vector<Row> someRows() {
    auto rows = rowsOf("paper1", "classic", {0.1, 1.0 / 3}) + rowsOf("paper1", "invariant", {0.3, 0.2});
    rows.push_back(failedRow("paper1", "invariant", 3));
    for (Row& row : rows) {
        row.config_point = {{"ekf.gate", "3"}};
        row.world_seed = 18446744073709551615u;
        if (row.status == "complete") row.series["robot_nees"] = {{0, 0.5}, {1.0 / 3, 4}, {3, 3}};
    }
    rows[0].cost.wall_s = 0.1 + 0.2;
    return rows;
}

class Export : public testing::Test {
  protected:
    void SetUp() override {
        StudyFile study = studyOf(text);
        study.config_grid = {{{"ekf.gate", "3"}}};
        const Analysis analysis = readAnalysis(study);
        const std::vector<Row> rows = someRows();
        try {
            exportStudy({study, analysis, rows}, folder_.path("out"));
        } catch (const report::ReportError& error) {
            not_drawn_ = error.what();  // no node on this machine: all but the figure is there
        }
    }

    /// The rows of a CSV as column and text, where nothing is quoted.
    std::vector<std::map<std::string, std::string>> read(const std::string& name) const {
        CsvReader csv(folder_.path("out/" + name));
        std::vector<std::map<std::string, std::string>> rows;
        while (csv.next()) {
            auto& row = rows.emplace_back();
            for (const std::string& column : csv.header()) row[column] = csv.text(csv.column(column));
        }
        return rows;
    }

    const test::TemporaryFolder folder_;
    std::string not_drawn_;
};

TEST_F(Export, RowsComeBackWithEveryBit) {
    const auto rows = read("rows.csv");
    ASSERT_EQ(rows.size(), 5u);
    EXPECT_EQ(rows[0].at("source"), "paper1");
    EXPECT_EQ(rows[0].at("ekf.gate"), "3");
    EXPECT_EQ(rows[0].at("world_seed"), "18446744073709551615");
    EXPECT_EQ(std::stod(rows[1].at("robot.position.rmse")), 1.0 / 3);
    EXPECT_EQ(std::stod(rows[0].at("cost.wall_s")), 0.1 + 0.2);
    EXPECT_EQ(rows[1].at("cost.wall_s"), "") << "a number that does not exist is empty";
    EXPECT_EQ(rows[4].at("status"), "failed");
    EXPECT_EQ(rows[4].at("reason"), "the covariance is not definite");
    EXPECT_EQ(rows[4].at("robot.position.rmse"), "");
}

TEST_F(Export, CellsHoldEveryFigureThereIs) {
    const auto cells = read("cells.csv");
    ASSERT_EQ(cells.size(), 3u) << "the error of both configs, wall time of one";
    EXPECT_EQ(cells[0].at("figure"), "robot.position.rmse");
    EXPECT_EQ(cells[0].at("n"), "2");
    EXPECT_EQ(std::stod(cells[0].at("mean")), (0.1 + 1.0 / 3) / 2);
    EXPECT_EQ(cells[1].at("figure"), "cost.wall_s");
    EXPECT_EQ(cells[2].at("config"), "invariant");
    EXPECT_EQ(cells[2].at("runs"), "3");
    EXPECT_EQ(cells[2].at("n"), "2");
}

TEST_F(Export, PairsInBothDirections) {
    const auto pairs = read("paired.csv");
    ASSERT_EQ(pairs.size(), 2u);
    EXPECT_EQ(pairs[1].at("config"), "invariant");
    EXPECT_EQ(pairs[1].at("against"), "classic");
    EXPECT_EQ(pairs[1].at("worlds"), "2");
    EXPECT_EQ(std::stod(pairs[1].at("difference.mean")), ((0.3 - 0.1) + (0.2 - 1.0 / 3)) / 2);
    EXPECT_EQ(pairs[1].at("smaller"), "1");
}

TEST_F(Export, DivergenceConsistencyAndRanks) {
    const auto divergence = read("divergence.csv"), steps = read("consistency.csv"),
               ranks = read("ranks.csv");
    ASSERT_EQ(divergence.size(), 2u);
    EXPECT_EQ(std::stod(divergence[1].at("rate")), 1.0 / 3);
    ASSERT_EQ(steps.size(), 4u) << "two steps of two configs";
    EXPECT_EQ(steps[1].at("t"), "0.5000000");
    EXPECT_EQ(std::stod(steps[0].at("mean")), 1.0 / 3);
    ASSERT_EQ(ranks.size(), 4u) << "over all sources, and over paper1";
    EXPECT_EQ(ranks[0].at("sources"), "all");
    EXPECT_EQ(ranks[0].at("mean"), "1.5");
    EXPECT_EQ(ranks[2].at("sources"), "paper1");
}

TEST_F(Export, TablesAndFigures) {
    EXPECT_THAT(folder_.read("out/tables/errors.md"), testing::HasSubstr("| paper1 | classic   |"));
    EXPECT_EQ(read("tables/errors.csv").size(), 2u);
    if (!not_drawn_.empty()) GTEST_SKIP() << not_drawn_;
    EXPECT_THAT(folder_.read("out/figures/nees.svg"), testing::HasSubstr("<svg"));
}

/// A study of one table, without rows: quick to export.
void exportTable(const std::string& study_name, const std::string& table, const std::string& folder) {
    StudyFile study = studyOf("[table." + table + "]\nkind = divergence\n");
    study.name = study_name;
    const Analysis analysis = readAnalysis(study);
    exportStudy({study, analysis, {}}, folder);
}

TEST_F(Export, OnlyItsOwnEarlierFilesGiveWay) {
    namespace fs = std::filesystem;
    const auto there = [&](const std::string& name) { return fs::exists(folder_.path("again/" + name)); };
    exportTable("demo", "old", folder_.path("again"));
    folder_.write("again/tables/notes.md", "mine");
    ASSERT_TRUE(there("tables/old.csv"));
    exportTable("demo", "new", folder_.path("again"));
    EXPECT_TRUE(there("tables/new.md"));
    EXPECT_TRUE(there("tables/notes.md"));
    EXPECT_FALSE(there("tables/old.md"));
    EXPECT_FALSE(there("tables/old.csv"));

    EXPECT_THAT(test::messageOf<LogError>([&] { exportTable("other", "x", folder_.path("again")); }),
                testing::HasSubstr("again: holds an export of the study 'demo', expected one of 'other'"));
    EXPECT_TRUE(there("tables/new.md"));
    EXPECT_THAT(test::messageOf<LogError>([&] { exportTable("demo", "x", folder_.path()); }),
                testing::HasSubstr("holds files that no export of a study made"));
}

TEST_F(Export, AFullDiskIsASentence) {
    for (const char* file : {"rows.csv", "ranks.csv", "tables/t.md"}) {
        const std::string out = folder_.path("full" + std::to_string(file[0]) + file[1]);
        exportTable("demo", "t", out);
        std::filesystem::create_symlink("/dev/full", out + "/" + file + ".part");
        EXPECT_THAT(test::messageOf<LogError>([&] { exportTable("demo", "t", out); }),
                    testing::HasSubstr(std::string(file) + ": cannot be written to its end"));
    }
}

TEST_F(Export, NothingOutsideTheFolderIsRemovedWhateverTheListSays) {
    folder_.write("precious", "mine");
    exportTable("demo", "t", folder_.path("in"));
    folder_.write("in/exported_files.txt", "demo\n../precious\n" + folder_.path("precious") + "\n");
    exportTable("demo", "t", folder_.path("in"));
    EXPECT_EQ(folder_.read("precious"), "mine");
}

TEST_F(Export, AFolderThatCannotBeMadeIsAnError) {
    folder_.write("file", "in the way");
    const StudyFile study = studyOf("");
    const Analysis analysis = readAnalysis(study);
    EXPECT_THROW(exportStudy({study, analysis, {}}, folder_.path("file/out")), std::runtime_error);
}

}  // namespace export_test
}  // namespace slamot::study

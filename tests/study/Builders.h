#pragma once
// Small studies and rows made by hand.
#include <string>
#include <vector>

#include "slamot/study/AnalysisFile.h"
#include "slamot/study/Row.h"

namespace slamot::study {

/// Sources `paper1` and `quiet`, configs `classic` and `invariant`, no grids; `text` holds the analysis.
inline StudyFile studyOf(const std::string& text) {
    StudyFile study;
    study.path = "demo.ini";
    study.name = "demo";
    study.parameters.series = {"robot_nees", "robot_error"};
    for (const char* name : {"paper1", "quiet"}) study.sources.emplace_back().name = name;
    for (const char* name : {"classic", "invariant"}) study.variants.emplace_back().name = name;
    study.config_grid = study.scenario_grid = {GridPoint{}};
    study.text = Config::fromText(text, "demo.ini");
    return study;
}

/// A complete run of no grid with one figure.
inline Row rowOf(const std::string& source, const std::string& variant, int replicate, double rmse) {
    Row row;
    row.key = source + "/" + variant + "/" + std::to_string(replicate);
    row.source = source;
    row.variant = variant;
    row.replicate = replicate;
    row.status = "complete";
    row.metrics["robot.position.rmse"] = rmse;
    return row;
}

inline Row failedRow(const std::string& source, const std::string& variant, int replicate) {
    Row row = rowOf(source, variant, replicate, 0);
    row.metrics.clear();
    row.status = "failed";
    row.reason = "the covariance is not definite";
    return row;
}

/// Rows of one source and config, replicates 1, 2, ...
inline std::vector<Row> rowsOf(const std::string& source, const std::string& variant,
                               const std::vector<double>& rmse) {
    std::vector<Row> rows;
    for (const double value : rmse)
        rows.push_back(rowOf(source, variant, static_cast<int>(rows.size()) + 1, value));
    return rows;
}

inline std::vector<Row> operator+(std::vector<Row> a, const std::vector<Row>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

}  // namespace slamot::study

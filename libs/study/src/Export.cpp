#include "slamot/study/Export.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "CostFields.h"
#include "CsvLine.h"
#include "ExportFolder.h"
#include "Selected.h"
#include "StatisticFields.h"
#include "slamot/rawlog/PartFile.h"
#include "slamot/report/Figure.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/study/Figures.h"

namespace slamot::study {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// A CSV with the columns that say which cell a line is about, all of them.
class CellCsv {
  public:
    CellCsv(const fs::path& file, const StudyFile& study, const Words& columns)
        : file_(file.string()),
          scenario_(addressesOf(study.scenario_grid)),
          config_(addressesOf(study.config_grid)) {
        file_.write(csvLine(Words{"source"} + scenario_ + Words{"config"} + config_ + columns));
    }
    void line(const std::string& source, const GridPoint& scenario_point, const std::string& variant,
              const GridPoint& config_point, const Words& fields) {
        Words identity = {source};
        for (const std::string& address : scenario_) identity.push_back(valueAt(scenario_point, address));
        identity.push_back(variant);
        for (const std::string& address : config_) identity.push_back(valueAt(config_point, address));
        file_.write(csvLine(identity + fields));
    }
    void line(const Cell& cell, const Words& fields) {
        line(cell.source, cell.scenario_point, cell.variant, cell.config_point, fields);
    }
    void close() { file_.close(); }

  private:
    PartFile file_;
    Words scenario_, config_;
};

const Words statistic_columns = [] {
    Words columns = {"n"};
    for (const StatisticField& number : statistic_fields) columns.push_back(number.name);
    return columns;
}();

Words fieldsOf(const Statistic& s) {
    Words fields = {std::to_string(s.count)};
    for (const StatisticField& number : statistic_fields) fields.push_back(csvNumber(s.*number.field));
    return fields;
}

Words prefixed(const std::string& prefix, const Words& words) {
    Words result;
    for (const std::string& word : words) result.push_back(prefix + word);
    return result;
}

class Exporter {
  public:
    Exporter(const Findings& findings, fs::path folder)
        : findings_(findings), study_(findings.study), folder_(std::move(folder)) {
        for (const Source& source : study_.sources) all_.sources.push_back(source.name);
        for (const Variant& variant : study_.variants) all_.configs.push_back(variant.name);
        cells_ = selectedCells(findings, all_);
        std::set<std::string> metrics;
        for (const Row& row : findings.rows)
            for (const auto& [name, value] : row.metrics) metrics.insert(name);
        figure_names_.assign(metrics.begin(), metrics.end());
        for (const auto& [cost, field] : cost_fields) figure_names_.push_back(std::string("cost.") + cost);
    }

    void rows() const {
        CellCsv csv(
            folder_ / "rows.csv", study_,
            Words{"replicate", "key", "world_seed", "estimator_seed", "status", "reason", "estimate_hash"} +
                figure_names_ + Words{"cost.host"});
        for (const Row& row : findings_.rows) {
            Words fields = {std::to_string(row.replicate),
                            row.key,
                            std::to_string(row.world_seed),
                            std::to_string(row.estimator_seed),
                            row.status,
                            row.reason,
                            row.estimate_hash};
            for (const std::string& figure : figure_names_)
                fields.push_back(csvNumber(figureOf(row, figure)));
            fields.push_back(row.cost.host);
            csv.line(row.source, row.scenario_point, row.variant, row.config_point, fields);
        }
        csv.close();
    }

    void cells() const {
        CellCsv csv(folder_ / "cells.csv", study_, Words{"runs", "figure"} + statistic_columns);
        for (const Cell& cell : cells_)
            for (const std::string& figure : figure_names_)
                if (const Statistic s = statisticOf(figureOf(cell, figure)); s.count > 0)
                    csv.line(cell, Words{std::to_string(cell.rows.size()), figure} + fieldsOf(s));
        csv.close();
    }

    void paired() const {
        CellCsv csv(folder_ / "paired.csv", study_,
                    Words{"against", "figure", "worlds"} + prefixed("difference.", statistic_columns) +
                        prefixed("ratio.", statistic_columns) + Words{"smaller", "equal"});
        for (const Cell& cell : cells_)
            for (const std::string& against : all_.configs) {
                const Cell* other = cellOf(cells_, cell, against);
                if (!other || other == &cell) continue;
                for (const std::string& figure : figure_names_) {
                    const Paired pair = compare(cell, *other, figure);
                    if (pair.difference.count == 0) continue;
                    csv.line(cell, Words{against, figure, std::to_string(pair.difference.count)} +
                                       fieldsOf(pair.difference) + fieldsOf(pair.ratio) +
                                       Words{std::to_string(pair.smaller), std::to_string(pair.equal)});
                }
            }
        csv.close();
    }

    void divergences() const {
        CellCsv csv(folder_ / "divergence.csv", study_,
                    {"runs", "failed", "judged", "diverged", "rate", "rate_low", "rate_high"});
        for (const Cell& cell : cells_) {
            const Divergence d = divergence(cell, study_.parameters.diverged_above);
            csv.line(cell, {std::to_string(cell.rows.size()), std::to_string(d.failed),
                            std::to_string(d.lost.of), std::to_string(d.diverged), csvNumber(d.lost.rate),
                            csvNumber(d.lost.low), csvNumber(d.lost.high)});
        }
        csv.close();
    }

    void consistency() const {
        std::set<std::string> names;
        for (const Row& row : findings_.rows)
            for (const auto& [name, series] : row.series)
                if (!series.dimension.empty()) names.insert(name);
        CellCsv csv(folder_ / "consistency.csv", study_, {"series", "t", "runs", "mean", "low", "high"});
        for (const Cell& cell : cells_)
            for (const std::string& name : names)
                if (const auto measured = consistencyOf(cell, name))
                    for (const eval::ConsistencyStep& step : measured->steps)
                        csv.line(cell,
                                 {name, toText(step.stamp), std::to_string(step.runs), csvNumber(step.mean),
                                  csvNumber(step.band.low), csvNumber(step.band.high)});
        csv.close();
    }

    /// Over all sources, and over each alone, among the configs that run on all of them.
    void ranks() const {
        PartFile file((folder_ / "ranks.csv").string());
        file.write(csvLine(Words{"sources", "figure", "config"} + statistic_columns));
        std::vector<std::pair<std::string, Words>> groups = {{"all", all_.sources}};
        for (const std::string& source : all_.sources) groups.push_back({source, {source}});
        for (const auto& [name, sources] : groups) {
            Words configs;
            for (const Variant& variant : study_.variants)
                if (runsOnAll(variant, sources)) configs.push_back(variant.name);
            for (const std::string& figure : figure_names_)
                for (const Ranked& ranked : rank(findings_.rows, sources, configs, figure))
                    if (ranked.rank.count > 0)
                        file.write(csvLine(Words{name, figure, ranked.variant} + fieldsOf(ranked.rank)));
        }
        file.close();
    }

    void tables() const {
        for (const TableSpec& spec : findings_.analysis.tables) {
            const Table table = makeTable(spec, findings_);
            write(folder_ / "tables" / (spec.name + ".md"), toMarkdown(table));
            write(folder_ / "tables" / (spec.name + ".csv"), toCsv(table));
        }
    }

    void plots() const {
        for (const PlotSpec& spec : findings_.analysis.plots)
            report::writeFigure(makeFigure(spec, findings_), folder_ / "figures" / spec.name,
                                {false, true, false});
    }

  private:
    static bool runsOnAll(const Variant& variant, const Words& sources) {
        const std::set<std::string> on(variant.on.begin(), variant.on.end());
        return on.empty() || std::all_of(sources.begin(), sources.end(),
                                         [&](const std::string& source) { return on.count(source) > 0; });
    }
    static void write(const fs::path& path, const std::string& text) {
        PartFile file(path.string());
        file.write(text);
        file.close();
    }

    const Findings& findings_;
    const StudyFile& study_;
    fs::path folder_;
    Selection all_;
    std::vector<Cell> cells_;
    Words figure_names_;
};

std::vector<fs::path> filesOf(const Analysis& analysis) {
    std::vector<fs::path> files = {"rows.csv",       "cells.csv",       "paired.csv",
                                   "divergence.csv", "consistency.csv", "ranks.csv"};
    for (const TableSpec& table : analysis.tables)
        for (const char* suffix : {".md", ".csv"})
            files.push_back(fs::path("tables") / (table.name + suffix));
    for (const PlotSpec& plot : analysis.plots) files.push_back(fs::path("figures") / (plot.name + ".svg"));
    return files;
}

}  // namespace

void exportStudy(const Findings& findings, const std::string& folder) {
    replaceExport(folder, findings.study.name, filesOf(findings.analysis));
    std::error_code error;  // PartFile says what is wrong when a file cannot be made
    fs::create_directories(fs::path(folder) / "tables", error);
    const Exporter exporter(findings, folder);
    exporter.rows();
    exporter.cells();
    exporter.paired();
    exporter.divergences();
    exporter.consistency();
    exporter.ranks();
    exporter.tables();
    exporter.plots();
}

}  // namespace slamot::study

#pragma once
// What a study file wants to be made of its rows: sections [labels], [units], [table.*], [figure.*] and
// [check.*].
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/config/Config.h"
#include "slamot/eval/Consistency.h"
#include "slamot/study/Plan.h"

namespace slamot::study {

/// `[units]`: what a figure is shown in instead of its own unit: SI, radians, for costs that of their name.
struct DisplayUnit {
    std::string name;
    double factor = 1;
};

/// What is shown of a Statistic.
enum class Shown { mean, median, both };

/// Names of the study's sources and configs, in its order. Never empty once read.
struct Selection {
    std::vector<std::string> sources, configs;
};

enum class TableKind { means, paired, consistency, divergence, ranks, runs };

struct TableSpec {
    std::string name;
    TableKind kind = TableKind::means;
    std::vector<std::string> figures, series;
    Shown shown = Shown::both;
    Selection selection;
    std::string baseline;
    int digits = 3;  ///< significant ones
    std::string caption;
};

enum class PlotKind { over_parameter, against, over_time, bands, one_run };

/// What a figure of one run shows.
enum class OneRunShow { map, robot, target, landmark_errors, correlation, correlation_head };

struct PlotSpec {
    std::string name;
    PlotKind kind = PlotKind::over_parameter;
    std::vector<std::string> figures, series;  ///< of `against`: two figures, along x and y
    Shown shown = Shown::mean;
    std::string parameter;  ///< address of the grid
    Selection selection;
    bool logarithmic_x = false, logarithmic_y = false;
    std::string title;
    // Of one run only.
    std::string source, config;
    int replicate = 1;
    OneRunShow show = OneRunShow::map;
};

struct CheckStatistic;  // CheckStatistic.cpp lists them

struct CheckSpec {
    std::string name, source, config, against, figure, series;
    const CheckStatistic* statistic = nullptr;  ///< never null once read
    GridPoint scenario_point, config_point;
    std::optional<eval::Band> window;  ///< [s] of the series
    eval::Band interval;
    std::optional<eval::Band> short_interval;
    double missing = 0;  ///< largest part of the runs that may be without the figure or series
    std::string about;
};

struct Analysis {
    std::map<std::string, std::string> labels;
    std::map<std::string, DisplayUnit> units;
    std::vector<TableSpec> tables;  ///< these three in the order of the file
    std::vector<PlotSpec> plots;
    std::vector<CheckSpec> checks;

    /// What a name is called in tables and figures: its label, or itself with its unit.
    std::string label(const std::string& name) const;
    /// 1 without a unit.
    double factor(const std::string& figure) const;
    /// The table of that name. Throws ConfigError.
    const TableSpec& table(const std::string& name) const;
    const PlotSpec& plot(const std::string& name) const;
};

/// Strict: unknown keys, figures, sources, configs, addresses and kinds are a ConfigError with file and line.
Analysis readAnalysis(const StudyFile& study);

/// Addresses of a grid, in the order of its first point.
std::vector<std::string> addressesOf(const std::vector<GridPoint>& grid);

}  // namespace slamot::study

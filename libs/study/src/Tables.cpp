#include "slamot/study/Tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "CsvLine.h"
#include "NumberText.h"
#include "Selected.h"
#include "StatisticFields.h"

namespace slamot::study {
namespace {

Field textField(const std::string& text) {
    return {text, {text}};
}
Field countField(int count) {
    return textField(std::to_string(count));
}
Field percentField(double part) {
    return {percentText(part), {csvNumber(part)}};
}
Field numberField(double value, int digits) {
    return {numberText(value, digits), {csvNumber(value)}};
}

Column statisticColumn(const std::string& heading, const std::string& name) {
    Column column{heading, {name + ".n"}, true};
    for (const StatisticField& number : statistic_fields)
        if (number.in_tables) column.csv.push_back(name + "." + number.name);
    return column;
}

/// `of` is how many values there could be: fewer are counted in the cell.
Field statisticField(const Statistic& s, const TableSpec& spec, int of) {
    std::string shown = statisticText(s, spec.shown, spec.digits);
    if (s.count > 0 && s.count < of) shown += fmt::format(", n = {}", s.count);
    Field field{shown, {std::to_string(s.count)}};
    for (const StatisticField& number : statistic_fields)
        if (number.in_tables) field.csv.push_back(csvNumber(s.*number.field));
    return field;
}

/// Builds one kind of table; lines start with what tells cells apart.
class Builder {
  public:
    Builder(const TableSpec& spec, const Findings& findings)
        : spec_(spec), findings_(findings), cells_(selectedCells(findings, spec.selection)) {
        table_.caption = spec.caption;
    }

    Table means() {
        table_.columns = identityColumns(findings_, spec_.selection);
        addCount("runs");
        for (const std::string& figure : spec_.figures) table_.columns.push_back(figureColumn(figure));
        for (const Cell& cell : cells_) {
            const int runs = static_cast<int>(cell.rows.size());
            TableLine& line = startLine(cell);
            line.fields.push_back(countField(runs));
            for (const std::string& figure : spec_.figures)
                line.fields.push_back(
                    statisticField(inUnit(statisticOf(figureOf(cell, figure)), figure), spec_, runs));
        }
        return table_;
    }

    Table paired() {
        const std::vector<Cell> all = cellsOf(findings_.rows);
        const std::string to = analysis().label(spec_.baseline);
        table_.columns = identityColumns(findings_, spec_.selection);
        table_.columns.push_back({"figure", {"figure"}, false});
        addCount("worlds");
        table_.columns.push_back(statisticColumn("difference to " + to, "difference"));
        table_.columns.push_back(statisticColumn("ratio to " + to, "ratio"));
        table_.columns.push_back({"smaller", {"smaller"}, true});
        for (const Cell& cell : cells_) {
            if (cell.variant == spec_.baseline) continue;
            const Cell* baseline = cellOf(all, cell, spec_.baseline);
            for (const std::string& figure : spec_.figures) {
                const Paired pair = baseline ? compare(cell, *baseline, figure) : Paired{};
                const int worlds = pair.difference.count;
                TableLine& line = startLine(cell);
                line.fields.push_back({analysis().label(figure), {csvName(analysis(), figure)}});
                line.fields.push_back(countField(worlds));
                line.fields.push_back(statisticField(inUnit(pair.difference, figure), spec_, worlds));
                line.fields.push_back(statisticField(pair.ratio, spec_, worlds));
                line.fields.push_back(
                    {worlds == 0 ? no_number : fmt::format("{} of {}", pair.smaller, worlds),
                     {std::to_string(pair.smaller)}});
            }
        }
        return table_;
    }

    Table consistency() {
        table_.columns = identityColumns(findings_, spec_.selection);
        if (spec_.series.size() > 1) table_.columns.push_back({"series", {"series"}, false});
        addCount("runs");
        for (const auto& [heading, name] :
             {std::pair("ANEES", "anees"), std::pair("expected", "expected"),
              std::pair("steps in band", "inside"), std::pair("above (over-confident)", "above"),
              std::pair("below", "below")})
            table_.columns.push_back({heading, {name}, true});
        for (const Cell& cell : cells_)
            for (const std::string& series : spec_.series) {
                const auto measured = consistencyOf(cell, series);
                const eval::ConsistencyOverRuns c = measured ? *measured : eval::ConsistencyOverRuns{};
                const double exists = measured ? 1 : Statistic::none;  // NaN times anything is NaN
                TableLine& line = startLine(cell);
                if (spec_.series.size() > 1) line.fields.push_back({analysis().label(series), {series}});
                const std::size_t runs = cell.rows.size();
                line.fields.push_back(
                    c.runs < static_cast<int>(runs)
                        ? Field{fmt::format("{} of {}", c.runs, runs), {std::to_string(c.runs)}}
                        : countField(c.runs));
                line.fields.push_back(numberField(exists * c.average, spec_.digits));
                line.fields.push_back(numberField(exists * c.mean_dimension, spec_.digits));
                for (const double part : {c.inside, c.above, c.below})
                    line.fields.push_back(percentField(exists * part));
            }
        return table_;
    }

    Table divergence() {
        table_.columns = identityColumns(findings_, spec_.selection);
        addCount("runs");
        addCount("failed");
        addCount("diverged");
        table_.columns.push_back({"rate", {"rate", "rate_low", "rate_high"}, true});
        for (const Cell& cell : cells_) {
            const Divergence d = study::divergence(cell, findings_.study.parameters.diverged_above);
            TableLine& line = startLine(cell);
            line.fields.push_back(countField(static_cast<int>(cell.rows.size())));
            line.fields.push_back(countField(d.failed));
            line.fields.push_back(countField(d.diverged.count));
            line.fields.push_back(
                {rateText(d.diverged),
                 {csvNumber(d.diverged.rate), csvNumber(d.diverged.low), csvNumber(d.diverged.high)}});
        }
        return table_;
    }

    /// Sorted by the first figure: a rank table says who is first.
    Table ranks() {
        table_.columns = {{analysis().label("config"), {"config"}, false}};
        addCount("worlds");
        std::vector<std::vector<Ranked>> by_figure;
        for (const std::string& figure : spec_.figures) {
            table_.columns.push_back(statisticColumn("rank by " + analysis().label(figure), figure));
            by_figure.push_back(
                rank(findings_.rows, spec_.selection.sources, spec_.selection.configs, figure));
        }
        std::vector<std::size_t> order;
        for (std::size_t i = 0; i < spec_.selection.configs.size(); ++i) order.push_back(i);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return by_figure[0][a].rank.mean < by_figure[0][b].rank.mean;
        });
        for (const std::size_t i : order) {
            int worlds = 0;
            for (const auto& ranked : by_figure) worlds = std::max(worlds, ranked[i].rank.count);
            TableLine& line = table_.lines.emplace_back();
            const std::string& config = spec_.selection.configs[i];
            line.fields = {{analysis().label(config), {config}}, countField(worlds)};
            for (const auto& ranked : by_figure)
                line.fields.push_back(statisticField(ranked[i].rank, spec_, worlds));
        }
        return table_;
    }

    /// One line per run, and below those of a cell their mean or median.
    Table runs() {
        const bool all_complete = std::all_of(cells_.begin(), cells_.end(), [](const Cell& cell) {
            return std::all_of(cell.rows.begin(), cell.rows.end(),
                               [](const Row* r) { return r->status == "complete"; });
        });
        table_.columns = identityColumns(findings_, spec_.selection);
        addCount("replicate");
        if (!all_complete) table_.columns.push_back({"status", {"status"}, false});
        for (const std::string& figure : spec_.figures)
            table_.columns.push_back({analysis().label(figure), {csvName(analysis(), figure)}, true});
        for (const Cell& cell : cells_) {
            for (const Row* row : cell.rows) {
                TableLine& line = startLine(cell);
                line.fields.push_back(countField(row->replicate));
                if (!all_complete) line.fields.push_back(textField(row->status));
                for (const std::string& figure : spec_.figures)
                    line.fields.push_back(
                        numberField(analysis().factor(figure) * figureOf(*row, figure), spec_.digits));
            }
            if (cell.rows.size() < 2) continue;
            if (spec_.shown != Shown::median) addSummary(cell, "mean", &Statistic::mean, all_complete);
            if (spec_.shown != Shown::mean) addSummary(cell, "median", &Statistic::median, all_complete);
        }
        return table_;
    }

  private:
    const Analysis& analysis() const { return findings_.analysis; }
    Statistic inUnit(const Statistic& s, const std::string& figure) const {
        return scaled(s, analysis().factor(figure));
    }
    Column figureColumn(const std::string& figure) const {
        return statisticColumn(analysis().label(figure), csvName(analysis(), figure));
    }
    void addCount(const std::string& name) {
        table_.columns.push_back({analysis().label(name), {name}, true});
    }
    TableLine& startLine(const Cell& cell) {
        TableLine& line = table_.lines.emplace_back();
        line.fields = identityFields(findings_, spec_.selection, cell);
        return line;
    }
    void addSummary(const Cell& cell, const char* name, double Statistic::*value, bool all_complete) {
        TableLine& line = startLine(cell);
        line.summary = true;
        line.fields.push_back({name, {}});
        if (!all_complete) line.fields.emplace_back();
        for (const std::string& figure : spec_.figures) {
            const Statistic s = inUnit(statisticOf(figureOf(cell, figure)), figure);
            std::string shown = numberText(s.*value, spec_.digits);
            if (s.count > 0 && s.count < static_cast<int>(cell.rows.size()))
                shown += fmt::format(", n = {}", s.count);
            line.fields.push_back({shown, {}});
        }
    }

    const TableSpec& spec_;
    const Findings& findings_;
    std::vector<Cell> cells_;
    Table table_;
};

}  // namespace

Table makeTable(const TableSpec& spec, const Findings& findings) {
    Builder builder(spec, findings);
    switch (spec.kind) {
        case TableKind::means:
            return builder.means();
        case TableKind::paired:
            return builder.paired();
        case TableKind::consistency:
            return builder.consistency();
        case TableKind::divergence:
            return builder.divergence();
        case TableKind::ranks:
            return builder.ranks();
        case TableKind::runs:
            return builder.runs();
    }
    return {};
}

}  // namespace slamot::study

#include "slamot/study/Checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "CheckStatistic.h"
#include "CsvLine.h"
#include "NumberText.h"
#include "Selected.h"
#include "slamot/eval/TerminalText.h"

namespace slamot::study {
namespace {

/// A value, or why there is none.
using Outcome = std::variant<double, std::string>;

/// The cell as far as it has been run, and how many runs the plan has of it.
struct PlannedCell {
    Cell cell;
    std::size_t planned = 0;
};

/// Rows are found by what they are called; those of replicates that are not planned do not count.
PlannedCell plannedCell(const Plan& plan, const std::vector<Row>& rows, const CheckSpec& check,
                        const std::string& variant) {
    PlannedCell result;
    result.cell = {check.source, variant, check.scenario_point, check.config_point, {}};
    const StudyFile& study = plan.study;
    Row called;
    std::vector<int> replicates;
    for (const WorldPlan& world : plan.worlds) {
        if (plan.sourceOf(world).name != check.source ||
            study.scenario_grid[world.scenario_point] != check.scenario_point)
            continue;
        for (const RunPlan& run : plan.runsOf(world)) {
            if (plan.variantOf(run).name != variant ||
                study.config_grid[run.config_point] != check.config_point)
                continue;
            if (replicates.empty()) setLabels(called, plan, world, run);
            replicates.push_back(world.replicate);
        }
    }
    std::sort(replicates.begin(), replicates.end());
    result.planned = replicates.size();
    for (const Row& row : rows)
        if (row.source == called.source && row.variant == called.variant &&
            row.scenario_point == called.scenario_point && row.config_point == called.config_point &&
            std::binary_search(replicates.begin(), replicates.end(), row.replicate))
            result.cell.rows.push_back(&row);
    return result;
}

/// Failed, or without the figure or series.
bool lacks(const Row& row, const CheckSpec& check) {
    if (hasFailed(row)) return true;
    if (check.series.empty()) return !std::isfinite(figureOf(row, check.figure));
    const auto found = row.series.find(check.series);
    return found == row.series.end() || found->second.value.empty();
}

/// What keeps a cell from being judged, or what to know about it when it can be.
struct Judgement {
    bool possible = true;
    std::string words;
};

Judgement judge(const PlannedCell& planned, const CheckSpec& check, const Plan& plan) {
    const Cell& cell = planned.cell;
    if (planned.planned == 0) {
        std::string why = fmt::format("source '{}' has no world here", cell.source);
        for (const std::string& reason : plan.skipped) why += "; " + reason;
        return {false, why};
    }
    if (cell.rows.size() < planned.planned)
        return {false, fmt::format("{} of {} runs of '{}' are missing", planned.planned - cell.rows.size(),
                                   planned.planned, cell.variant)};
    if (check.figure.empty() && check.series.empty()) return {};  // the rate counts failed runs itself
    std::size_t without = 0;
    std::string example;
    for (const Row* row : cell.rows)
        if (lacks(*row, check)) {
            ++without;
            if (example.empty()) example = row->reason;
        }
    if (without == 0) return {};
    return {static_cast<double>(without) <= check.missing * static_cast<double>(planned.planned),
            fmt::format("{} of {} runs of '{}' are without the {}{}{}", without, planned.planned,
                        cell.variant, check.series.empty() ? "figure" : "series",
                        example.empty() ? "" : ", the first since: ", example)};
}

/// What the check's statistic has to be told.
class Evaluation {
  public:
    Evaluation(const CheckSpec& check, const Cell& cell, const Cell& against, double factor,
               double diverged_above)
        : check_(check), cell_(cell), against_(against), factor_(factor), diverged_above_(diverged_above) {}

    Outcome operator()(OfFigure value) const {
        return inUnit(value(statisticOf(figureOf(cell_, check_.figure))), "no run has the figure");
    }
    Outcome operator()(OfPairs value) const {
        return inUnit(value(compare(cell_, against_, check_.figure)),
                      "no world has the figure in both configs, as something to divide by");
    }
    Outcome operator()(OfSeries value) const {
        const auto measured = consistencyOf(cell_, check_.series);
        if (!measured) return measured.whyAbsent();
        return value(*measured);
    }
    Outcome operator()(OfWindow value) const {
        return inUnit(value.of(statisticOf(windowMeans(cell_, check_.series, *check_.window))),
                      "no run has the series in the window");
    }
    Outcome operator()(OfDivergence value) const {
        return inUnit(value(divergence(cell_, diverged_above_)), "no run says where the robot was in truth");
    }

  private:
    Outcome inUnit(double value, const std::string& why_none) const {
        if (std::isnan(value)) return why_none;
        return check_.statistic->in_unit ? factor_ * value : value;
    }

    const CheckSpec& check_;
    const Cell &cell_, &against_;
    double factor_, diverged_above_;
};

std::string describe(const CheckSpec& check, const Analysis& analysis) {
    const std::string& figure = check.figure.empty() ? check.series : check.figure;
    std::string text = fmt::format(fmt::runtime(check.statistic->words), analysis.label(figure));
    if (check.window) text += fmt::format(" from {} to {} s", check.window->low, check.window->high);
    text += fmt::format(", {}, {}", analysis.label(check.source), analysis.label(check.config));
    if (!check.against.empty()) text += " to " + analysis.label(check.against);
    for (const auto* point : {&check.scenario_point, &check.config_point})
        for (const auto& [address, value] : *point)
            text += fmt::format(", {} = {}", analysis.label(address), value);
    return text;
}

}  // namespace

bool CheckReport::passed() const {
    const auto is = [](CheckState state) {
        return [state](const CheckResult& r) { return r.state == state; };
    };
    return std::none_of(results.begin(), results.end(), is(CheckState::failed)) &&
           std::any_of(results.begin(), results.end(), is(CheckState::passed));
}

CheckReport runChecks(const Analysis& analysis, const Plan& plan, const std::vector<Row>& rows,
                      bool short_form) {
    CheckReport report;
    for (const CheckSpec& check : analysis.checks) {
        CheckResult& result = report.results.emplace_back();
        result.name = check.name;
        result.what = describe(check, analysis);
        result.about = check.about;
        result.interval = check.interval;
        if (short_form && !check.short_interval) {
            result.reason = "not part of the short form";
            continue;
        }
        if (short_form) result.interval = *check.short_interval;

        result.state = CheckState::failed;
        const PlannedCell planned = plannedCell(plan, rows, check, check.config);
        Judgement judgement = judge(planned, check, plan);
        PlannedCell against;
        result.reason = judgement.words;
        if (!check.against.empty() && judgement.possible) {
            against = plannedCell(plan, rows, check, check.against);
            judgement = judge(against, check, plan);
            if (!judgement.possible || result.reason.empty())
                result.reason = judgement.words;
            else if (!judgement.words.empty())
                result.reason += "; " + judgement.words;
        }
        if (!judgement.possible) continue;

        const Evaluation evaluation(check, planned.cell, against.cell,
                                    analysis.factor(check.figure.empty() ? check.series : check.figure),
                                    plan.study.parameters.diverged_above);
        const Outcome outcome = std::visit(evaluation, check.statistic->value);
        if (const double* value = std::get_if<double>(&outcome)) {
            result.value = *value;
            if (result.interval.contains(*value)) result.state = CheckState::passed;
        } else {
            result.reason = std::get<std::string>(outcome);
        }
    }
    return report;
}

namespace {

std::string stateText(CheckState state) {
    return state == CheckState::passed ? "passed" : state == CheckState::failed ? "FAILED" : "not checked";
}

/// What a check left out or lacked, and what it is about.
std::string remarkText(const CheckResult& r) {
    return r.reason + (r.about.empty() || r.reason.empty() ? "" : "; ") + r.about;
}

}  // namespace

std::string toTerminal(const CheckReport& report) {
    std::string text;
    for (const CheckResult& r : report.results) {
        text += fmt::format("{:<11}  {}\n", stateText(r.state), r.name);
        text += eval::wrapped(fmt::format("{}: {}, expected {} to {}", r.what, numberText(r.value, 5),
                                          csvNumber(r.interval.low), csvNumber(r.interval.high)),
                              4, 6);
        if (const std::string remark = remarkText(r); !remark.empty()) text += eval::wrapped(remark, 4, 6);
    }
    return text;
}

Table checkTable(const CheckReport& report) {
    Table table;
    table.columns = {{"check", {"check"}, false},
                     {"what", {"what"}, false},
                     {"value", {"value"}, true},
                     {"from", {"from"}, true},
                     {"to", {"to"}, true},
                     {"result", {"result"}, false},
                     {"about", {"about", "reason"}, false}};
    for (const CheckResult& r : report.results) {
        const std::string state = stateText(r.state);
        const auto number = [](double value) { return Field{numberText(value, 5), {csvNumber(value)}}; };
        const auto bound = [](double value) { return Field{csvNumber(value), {csvNumber(value)}}; };
        table.lines.push_back({{{r.name, {r.name}},
                                {r.what, {r.what}},
                                number(r.value),
                                bound(r.interval.low),
                                bound(r.interval.high),
                                {state, {state}},
                                {remarkText(r), {r.about, r.reason}}}});
    }
    return table;
}

}  // namespace slamot::study

#include "Selected.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "Words.h"

namespace slamot::study {
namespace {

/// Unknown ones come last: rows of another version of the file.
template <class T>
std::size_t placeOf(const std::vector<T>& list, const T& item) {
    return static_cast<std::size_t>(std::find(list.begin(), list.end(), item) - list.begin());
}

Field plain(const std::string& shown, const std::string& raw) {
    return {shown, {raw}};
}

}  // namespace

std::vector<Cell> selectedCells(const Findings& findings, const Selection& selection) {
    std::vector<Cell> cells;
    for (Cell& cell : cellsOf(findings.rows))
        if (contains(selection.sources, cell.source) && contains(selection.configs, cell.variant))
            cells.push_back(std::move(cell));
    const auto place = [&](const Cell& cell) {
        return std::tuple(placeOf(selection.sources, cell.source),
                          placeOf(findings.study.scenario_grid, cell.scenario_point),
                          placeOf(selection.configs, cell.variant),
                          placeOf(findings.study.config_grid, cell.config_point));
    };
    std::stable_sort(cells.begin(), cells.end(),
                     [&](const Cell& a, const Cell& b) { return place(a) < place(b); });
    return cells;
}

const Cell* cellOf(const std::vector<Cell>& cells, const Cell& like, const std::string& variant) {
    const auto found = std::find_if(cells.begin(), cells.end(), [&](const Cell& cell) {
        return cell.variant == variant && cell.source == like.source &&
               cell.scenario_point == like.scenario_point && cell.config_point == like.config_point;
    });
    return found == cells.end() ? nullptr : &*found;
}

std::string valueAt(const GridPoint& point, const std::string& address) {
    for (const auto& [name, value] : point)
        if (name == address) return value;
    return {};
}

std::vector<std::string> variedAddresses(const std::vector<GridPoint>& grid) {
    std::vector<std::string> varied;
    for (const std::string& address : addressesOf(grid)) {
        std::set<std::string> values;
        for (const GridPoint& point : grid) values.insert(valueAt(point, address));
        if (values.size() > 1) varied.push_back(address);
    }
    return varied;
}

std::vector<Column> identityColumns(const Findings& findings, const Selection& selection) {
    const StudyFile& study = findings.study;
    std::vector<Column> columns;
    const auto add = [&](const std::string& name) {
        columns.push_back({findings.analysis.label(name), {name}, false});
    };
    if (selection.sources.size() > 1) add("source");
    for (const std::string& address : variedAddresses(study.scenario_grid)) add(address);
    add("config");
    for (const std::string& address : variedAddresses(study.config_grid)) add(address);
    return columns;
}

std::vector<Field> identityFields(const Findings& findings, const Selection& selection, const Cell& cell) {
    const StudyFile& study = findings.study;
    const Analysis& analysis = findings.analysis;
    std::vector<Field> fields;
    if (selection.sources.size() > 1) fields.push_back(plain(analysis.label(cell.source), cell.source));
    for (const std::string& address : variedAddresses(study.scenario_grid)) {
        const std::string value = valueAt(cell.scenario_point, address);
        fields.push_back(plain(value, value));
    }
    fields.push_back(plain(analysis.label(cell.variant), cell.variant));
    for (const std::string& address : variedAddresses(study.config_grid)) {
        const std::string value = valueAt(cell.config_point, address);
        fields.push_back(plain(value, value));
    }
    return fields;
}

std::string csvName(const Analysis& analysis, const std::string& figure) {
    const auto unit = analysis.units.find(figure);
    return unit == analysis.units.end() ? figure : figure + "_" + unit->second.name;
}

}  // namespace slamot::study

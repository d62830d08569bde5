#pragma once
// The part of a study a table or figure is about, and what tells its lines apart.
#include "slamot/study/Analysis.h"
#include "slamot/study/Tables.h"

namespace slamot::study {

/// Cells of the selection: by source, point of the scenario's grid, config, point of its grid, each in the
/// order of the selection and the file.
std::vector<Cell> selectedCells(const Findings& findings, const Selection& selection);

/// The cell of the same worlds and the same point of the configs' grid; null when there is none.
const Cell* cellOf(const std::vector<Cell>& cells, const Cell& like, const std::string& variant);

/// The value at an address; empty when the point lacks it.
std::string valueAt(const GridPoint& point, const std::string& address);

/// Addresses that take more than one value in the study.
std::vector<std::string> variedAddresses(const std::vector<GridPoint>& grid);

/// Columns that say which cell a line is about: source (where several are selected), addresses of grids,
/// config.
std::vector<Column> identityColumns(const Findings& findings, const Selection& selection);
std::vector<Field> identityFields(const Findings& findings, const Selection& selection, const Cell& cell);

/// The name of a figure in CSV headers, with its unit if that is not SI.
std::string csvName(const Analysis& analysis, const std::string& figure);

}  // namespace slamot::study

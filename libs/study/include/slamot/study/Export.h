#pragma once
// A study's outcome as files.
#include <string>

#include "slamot/study/Tables.h"

namespace slamot::study {

/// Writes into `folder`, which is made: rows.csv, cells.csv, paired.csv, ranks.csv, divergence.csv and
/// consistency.csv, in SI units, of all sources, configs and figures; then what the study file asks for:
/// tables/NAME.md and .csv and figures/NAME.svg. The files of an earlier export of the study give way,
/// whatever they were. Throws LogError where a file cannot be written and for a folder with anything else in
/// it, and report::ReportError where a figure cannot be drawn; everything else has been written by then.
void exportStudy(const Findings& findings, const std::string& folder);

}  // namespace slamot::study

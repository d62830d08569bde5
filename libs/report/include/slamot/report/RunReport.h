#pragma once
// report.html of one run.
#include "slamot/report/Page.h"
#include "slamot/report/RunFolder.h"

namespace slamot::report {

/// Every section that has something to show, and a last one that says what is not shown and why. A function
/// of the run's files alone.
Page runPage(const RunFolder& run);

/// Reads the folder again and writes its report.html; throws LogError and ReportError.
void writeRunReport(const std::string& folder);

}  // namespace slamot::report

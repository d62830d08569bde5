#pragma once
// A study as one self-contained page of interactive plots.
#include <string>

#include "slamot/study/Page.h"

namespace slamot::study {

/// Writes all tables and figures that the study file asks for, the checks where `checks` is not null, and
/// what was run. Throws report::ReportError where the file cannot be written.
void writeReport(const std::string& file, const Findings& findings, const Provenance& provenance,
                 const CheckReport* checks);

}  // namespace slamot::study

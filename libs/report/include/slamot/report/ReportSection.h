#pragma once
// The parts of a run's page. A new one is a file in src/sections with one ReportSection, named in
// RunReport.cpp.
#include <string>
#include <vector>

#include "slamot/report/Page.h"
#include "slamot/report/RunFolder.h"

namespace slamot::report {

struct ReportSection {
    const char* id;
    const char* title;
    const char* about;
    /// Why the section has nothing to show of a run, as a clause ("the run had no truth"); empty where it
    /// has.
    std::string (*why_absent)(const RunFolder&);
    std::vector<Block> (*blocks)(const RunFolder&);
};

/// In the order of the page.
const std::vector<const ReportSection*>& runSections();

}  // namespace slamot::report

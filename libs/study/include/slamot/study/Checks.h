#pragma once
// Is a study's outcome still what its file says it must be? The regression test for accuracy.
#include <string>
#include <vector>

#include "slamot/study/Tables.h"

namespace slamot::study {

enum class CheckState { passed, failed, not_checked };

struct CheckResult {
    std::string name;
    std::string what;  ///< "mean of robot RMSE, paper1, invariant"
    CheckState state = CheckState::not_checked;
    double value = Statistic::none;  ///< in the unit of the figure
    eval::Band interval;
    std::string reason;  ///< why it failed without a value or was not checked; runs left out
    std::string about;
};

struct CheckReport {
    std::vector<CheckResult> results;
    /// None failed, and one at least was checked.
    bool passed() const;
};

/// Takes the rows of the plan only: a store may hold a longer study. Fails where a row is missing or, but for
/// the part that the check allows, without the figure or series. Values are in the units of [units].
CheckReport runChecks(const Analysis& analysis, const Plan& plan, const std::vector<Row>& rows,
                      bool short_form);

Table checkTable(const CheckReport& report);

/// The same for the terminal: at most 80 columns.
std::string toTerminal(const CheckReport& report);

}  // namespace slamot::study

#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "slamot/eval/Options.h"

namespace slamot::report {

/// FOLDER/summary.json. Throws LogError naming the file where no run has left it, or where what the page
/// takes from it is of another kind than a run writes.
nlohmann::json readSummary(const std::string& folder);

/// How the run was evaluated: as its metrics say, without metrics as [eval] of its settings says. Throws
/// LogError naming the file.
eval::EvaluationOptions evaluationOf(const nlohmann::json& summary, const std::string& folder);

}  // namespace slamot::report

#pragma once
// What every program that runs studies does around the runs: read, lay out, open the store, say how it went.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "slamot/study/Plan.h"
#include "slamot/study/Runner.h"
#include "slamot/study/Store.h"

namespace slamot::study {

struct SessionRequest {
    std::string study_file, store_file;
    bool short_form = false, any_build = false;
    bool retry_failed = false;  ///< run again what is a row with status failed
    std::optional<int> replicates;
};

/// Reads the study and lays it out. Throws ConfigError, PluginError or LogError.
Plan planOf(const SessionRequest& request, const PluginRegistry& registry);

class Session {
  public:
    /// Throws ConfigError, PluginError or LogError.
    Session(const SessionRequest& request, const PluginRegistry& registry);

    const Plan& plan() const { return plan_; }
    Store& store() { return store_; }
    /// What of the shard is still to be run, failed runs too where they are to be run again.
    std::vector<Unit> missing(const Shard& shard) const;
    /// Takes the rows of other files of the study; a sentence for each that is not there. Throws LogError.
    std::vector<std::string> merge(const std::vector<std::string>& files);
    /// Whether all of the plan's rows are there.
    bool isComplete() const { return store_.done(plan_).size() == plan_.keys().size(); }
    /// The plan's rows that are there.
    std::vector<Row> rows() const { return store_.rows(plan_); }

    /// `120 of 300 runs are there, 3 failed` and the first reasons, a line each.
    std::string stateInWords() const;

  private:
    SessionRequest request_;
    Plan plan_;
    Store store_;
};

/// Beside the store: where the imported logs of its studies are.
std::string workFolderOf(const std::string& store_file);

/// One line at the end: runs, failed, wall time, speed-up, overhead. `wall_s` is the whole program's.
std::string timesInWords(const StudyProgress& progress, double wall_s, double runs_s, int threads);

}  // namespace slamot::study

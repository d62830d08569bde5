#pragma once
// The rows of a study in a SQLite file, written as they come, read back in the plan's order.
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "slamot/study/Row.h"

namespace slamot::study {

class Store {
  public:
    /// Opens or creates. Throws LogError for a file that is no study's, or another study's.
    Store(const std::string& file, const StudyFile& study);
    ~Store();

    /// Throws LogError when another build of the program made rows of the plan: they may not be what this one
    /// would compute.
    void requireBuild(const Plan& plan) const;
    /// The plan's runs that are there; failed ones are not where `but_failed`.
    std::set<std::string> done(const Plan& plan, bool but_failed = false) const;
    /// On disk when this returns: a kill loses nothing that was added. Replaces a failed row of the same key;
    /// throws LogError when there is any other that differs.
    void add(const Row& row);
    /// Those of the plan, by source, scenario's point, variant, config's point, replicate, each as the plan
    /// has them. Rows of earlier forms of the study stay in the file and are left out.
    std::vector<Row> rows(const Plan& plan) const;
    /// Rows in the file, whatever the plan.
    std::size_t count() const;
    /// Takes all rows of another store of the same study, or none of them. Where one of two rows of a key has
    /// failed, the other is kept. Throws LogError when two that did not fail differ and, unless `any_build`, for
    /// rows of the plan that another build made.
    void merge(const std::string& file, const Plan& plan, bool any_build);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace slamot::study

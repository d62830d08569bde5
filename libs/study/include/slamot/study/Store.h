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

    /// The plan's runs that are there. Rows of the plan that another build of the program made are refused
    /// with a LogError unless `any_build`: they may not be what this one would compute.
    std::set<std::string> done(const Plan& plan, bool any_build) const;
    /// On disk when this returns: a kill loses nothing that was added. A row that is there already stays.
    void add(const Row& row);
    void erase(const std::set<std::string>& keys);
    /// Those of the plan, by source, scenario's point, variant, config's point, replicate, each as the plan
    /// has them. Rows of earlier forms of the study stay in the file and are left out.
    std::vector<Row> rows(const Plan& plan) const;
    /// Rows in the file, whatever the plan.
    std::size_t count() const;
    /// Takes the rows of other stores of the same study. Throws LogError; two different rows of one key are
    /// an error.
    void merge(const std::vector<std::string>& files);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace slamot::study

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
    /// Opens or creates. Throws LogError for a file that is no study's, or another study's. Rows made by another
    /// build of the program are refused unless `any_build`: they may not be what this one would compute.
    Store(const std::string& file, const StudyFile& study, const std::string& build, bool any_build);
    ~Store();

    std::set<std::string> keys() const;
    /// Written in batches; a kill loses the last second at most. A row that is there already stays.
    void add(const Row& row);
    void flush();
    void erase(const std::set<std::string>& keys);
    std::vector<Row> rows() const;
    /// Takes the rows of other stores of the same study. Throws LogError; two different rows of one key are an error.
    void merge(const std::vector<std::string>& files);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// SHA-256 over the files of the running program, its libraries and the plugins used: two equal ones compute alike.
std::string buildIdentity(const PluginRegistry& registry);

}  // namespace slamot::study

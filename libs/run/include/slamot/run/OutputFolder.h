#pragma once
// The folder a run leaves: its streams as sinks, its summary at the end. doc/output_files.md lists the files.
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "slamot/run/RunConfig.h"
#include "slamot/run/Sink.h"

namespace slamot::run {

class OutputFolder {
  public:
    /// Makes the folder and takes away what an earlier run left there. Throws LogError where others' files,
    /// or the log itself (empty: none), would be overwritten.
    OutputFolder(const std::string& folder, const AssembledRun& assembled, const std::string& log_file);
    std::vector<Sink*> sinks() const;
    /// summary.json.
    void writeSummary(const nlohmann::json& summary) const;

  private:
    std::string folder_;
    std::vector<std::unique_ptr<Sink>> sinks_;
};

}  // namespace slamot::run

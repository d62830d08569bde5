#pragma once
// A log that is in memory already: what a rawlog with these observations would give, entry for entry.
#include <memory>
#include <vector>

#include "slamot/rawlog/LogSource.h"
#include "slamot/rawlog/RawlogReader.h"

namespace slamot {

class MemoryLog : public LogSource {
  public:
    /// The observations are shared, not changed: several runs may read one list at the same time.
    MemoryLog(std::shared_ptr<const std::vector<mrpt::obs::CObservation::Ptr>> observations,
              const LogParameters& parameters);
    ~MemoryLog() override;

    std::optional<LogEntry> next() override;
    LogEnd end() const override;
    const std::string& endMessage() const override;
    const DropTable& drops() const override;
    double progress() const override;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace slamot

#pragma once
// The world of a unit: observations and truth, in memory.
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "slamot/rawlog/LogSource.h"
#include "slamot/rawlog/RawlogReader.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/study/Plan.h"

namespace slamot::study {

class World {
  public:
    /// Simulates, or reads the truth. `stopped` is asked now and then; throws Stopped when it says so.
    World(const Plan& plan, const WorldPlan& world, const std::function<bool()>& stopped);

    /// A fresh pass over the log.
    std::unique_ptr<LogSource> log(const LogParameters& parameters) const;
    const Truth* truth() const { return has_truth_ ? &truth_ : nullptr; }
    /// For messages: without folders, so that rows do not depend on where a log lies.
    const std::string& name() const { return name_; }
    /// A message without the log's folders or, at its begin, the world's name: rows do not depend on them.
    std::string withoutPlace(std::string message) const;
    /// Of simulating, or of reading the truth.
    double secondsToMake() const { return seconds_to_make_; }

    struct Stopped {};

  private:
    void simulate(const Plan& plan, const WorldPlan& world, const std::function<bool()>& stopped);

    std::string name_, log_file_;
    std::shared_ptr<const std::vector<mrpt::obs::CObservation::Ptr>> observations_;
    Truth truth_;
    bool has_truth_ = false;
    double seconds_to_make_ = 0;
};

}  // namespace slamot::study

#pragma once
// What a run costs the machine.
#include <string>

namespace slamot::study {

/// Most memory that the process takes beyond what it had at `start`. Only one at a time means anything.
class MemoryMeter {
  public:
    void start();
    /// [MB]; NaN where the system does not tell.
    double most() const;

  private:
    double before_ = 0;
};

std::string hostName();

}  // namespace slamot::study

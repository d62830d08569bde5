#pragma once
// How far sensors see that do not say so.
#include <map>
#include <string>

#include "slamot/core/data/Detections.h"

namespace slamot {

class SensorLimits {
  public:
    void clear() { farthest_.clear(); }
    /// The same set; a sensor without a max_range has the longest range at which its label has detected
    /// anything yet. One that has not detected anything keeps 0.
    RangeBearingSet completed(RangeBearingSet seen);

  private:
    std::map<std::string, double> farthest_;  ///< [m], by label
};

}  // namespace slamot

#pragma once
// From what a log's observations say to what an estimator is given: roles, identities, noise, clutter.
#include <vector>

#include "slamot/rawlog/LogSource.h"
#include "slamot/run/Clutter.h"
#include "slamot/run/RunConfig.h"

namespace slamot::run {

class DetectionBuilder {
  public:
    /// Drops go to `drops`, what [clutter] does to `counts`.
    DetectionBuilder(const RunConfig& config, DropTable& drops, ClutterCounts& counts);

    /// Adds the observation's sensor and detections to the set and, for each detection, its number among
    /// those that the log has at its stamp to `log_numbers`: -1 for false ones. The sensor's label must have
    /// a role.
    void append(const HeldReading& held, RangeBearingSet& set, std::vector<int>& log_numbers);

  private:
    Matrix2 noiseOf(const RangeBearingReading& reading, const RangeBearingReading::Item& item) const;

    const RunConfig& config_;
    DropTable& drops_;
    Clutter clutter_;
};

}  // namespace slamot::run

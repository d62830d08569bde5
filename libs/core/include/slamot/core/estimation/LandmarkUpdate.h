#pragma once
// The landmarks' part of a step where the joint state has one mode and movers keep theirs beside it.
#include <vector>

#include "slamot/core/estimation/ModalState.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

class LandmarkUpdate {
  public:
    /// One batch of all known landmarks that pass the gate.
    void operator()(JointMode& joint, Consistency consistency, const OutlierGate& gate,
                    const RangeBearingSet& seen, const std::vector<KnownObjects::Sight>& landmarks,
                    std::vector<Innovation>& innovations);

  private:
    Eigen::VectorXd certain_ = Eigen::VectorXd::Ones(1);  ///< weight of the only mode
    std::vector<LinearMeasurement> batch_;                ///< kept for its capacity
    std::vector<Linearisation> linear_;
};

}  // namespace slamot

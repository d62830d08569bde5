#include "slamot/core/estimation/LandmarkUpdate.h"

namespace slamot {

void LandmarkUpdate::operator()(JointMode& joint, Consistency consistency, const OutlierGate& gate,
                                const RangeBearingSet& seen,
                                const std::vector<KnownObjects::Sight>& landmarks,
                                std::vector<Innovation>& innovations) {
    batch_.clear();
    for (const auto& sight : landmarks) {
        const RangeBearingDetection& detection = seen.detections[sight.detection];
        linear_.assign(
            1, linearise(joint, sight.block, detection, seen.sensors[detection.sensor].pose, consistency));
        Innovation& innovation = innovations[sight.detection];
        linear_.front().measurement.R += gate.judge(certain_, linear_, detection, innovation);
        if (innovation.outcome != Outcome::rejected) batch_.push_back(linear_.front().measurement);
    }
    joint.update(batch_);
}

}  // namespace slamot

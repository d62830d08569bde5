#include "slamot/core/estimation/JointEngine.h"

#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/estimation/DenseJointBank.h"

namespace slamot {

std::unique_ptr<JointBank> makeJointBank(const JointEngine& engine, const PoseGaussian& robot,
                                         Consistency consistency, int modes) {
    const Vector3 mean = robot.mean.vector();
    if (engine.kind == JointEngine::Kind::dense)
        return std::make_unique<DenseJointBank>(mean, robot.covariance, consistency, modes);
    return std::make_unique<CompressedJointBank>(mean, robot.covariance, consistency, modes,
                                                 engine.active_set, engine.background);
}

}  // namespace slamot

#pragma once
// Which engine keeps a joint state, and its settings.
#include <memory>

#include "slamot/core/data/Pose2.h"
#include "slamot/core/estimation/ActiveSetPolicy.h"
#include "slamot/core/estimation/JointBank.h"

namespace slamot {

struct JointEngine {
    enum class Kind {
        dense,      ///< one full covariance per mode
        compressed  ///< what is near the sensors, and one map for all modes; whole as long as that is faster
    };
    Kind kind = Kind::compressed;
    ActiveSetParameters active_set;
    /// compressed: what is put away is worked on by a thread of its own; the numbers are the same.
    bool background = false;
};

/// A bank of modes that are all at `robot`.
std::unique_ptr<JointBank> makeJointBank(const JointEngine& engine, const PoseGaussian& robot,
                                         Consistency consistency, int modes);

}  // namespace slamot

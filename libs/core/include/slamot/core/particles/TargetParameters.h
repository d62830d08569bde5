#pragma once
// All parameters of movers in a particle filter.
#include <string>
#include <vector>

#include "slamot/core/association/BatchAssociation.h"
#include "slamot/core/estimation/OutlierGate.h"
#include "slamot/core/filter/ObjectLifeParameters.h"
#include "slamot/core/particles/LandmarksAndTargets.h"
#include "slamot/core/particles/ParticleCloud.h"

namespace slamot {

struct TargetParticleParameters {
    ParticleParameters particles{100, PoseProposal::motion, GaussianTransform::linear};
    /// Whether movers' detections weigh particles: a wrong motion model of theirs then harms the robot.
    bool weigh_targets = true;

    LandmarkFilterParameters landmarks;

    TargetDrive drive = TargetDrive::modes;
    ControlledTarget control;
    ImmParameters imm;  ///< its modes are the target models, one or several
    double velocity_std = 3;      ///< [m/s] at first sight
    double acceleration_std = 2;  ///< [m/s^2]
    double max_unseen = 5;        ///< [s]; a track unseen for longer ends
    OutlierGate outliers;         ///< of movers

    MoverAssociation association = MoverAssociation::gnn;
    ObjectLifeParameters life;  ///< of movers, and of what may be either; not its `landmarks`

    TargetParticleParameters();
};

/// Tables of the section `[name]` and its parts.
std::vector<ParameterTable> describe(TargetParticleParameters& parameters, const std::string& name,
                                     const std::string& about);

/// Empty for movers of one motion.
std::vector<std::string> modeNames(const TargetParticleParameters& parameters);

/// Throw std::invalid_argument with one sentence when the modes do not fit together.
TargetSettings targetSettings(const TargetParticleParameters& parameters);
/// How moments over particles meet the sensor model: as the particles themselves do it, to first or second order.
Consistency consistencyOf(const TargetParticleParameters& parameters);
/// What movers without identity and objects of unknown kind live by.
ObjectLifeParameters lifeOf(const TargetParticleParameters& parameters);
/// Which detection is of which mover.
AssociationParameters associationOf(const TargetParticleParameters& parameters);

}  // namespace slamot

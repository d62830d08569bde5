#include "slamot/core/particles/TargetParameters.h"

namespace slamot {

TargetParticleParameters::TargetParticleParameters() {
    TargetMode cv{"cv", {}};
    cv.model.noise_std = 0.5;
    imm.modes = {cv};
}

std::vector<std::string> modeNames(const TargetParticleParameters& p) {
    std::vector<std::string> names;
    if (p.drive == TargetDrive::modes && p.imm.modes.size() > 1)
        for (const TargetMode& mode : p.imm.modes) names.push_back(mode.name);
    return names;
}

TargetSettings targetSettings(const TargetParticleParameters& p) {
    TargetSettings out;
    out.drive = p.drive;
    out.control = p.control;
    out.models = modelsOf(p.imm);
    out.chain = chainOf(p.imm);
    out.initial = initialProbabilities(p.imm);
    out.transform = p.particles.transform;
    return out;
}

Consistency consistencyOf(const TargetParticleParameters& p) {
    return p.particles.transform == GaussianTransform::linear ? Consistency::classic : Consistency::invariant;
}

ObjectLifeParameters lifeOf(const TargetParticleParameters& p) {
    ObjectLifeParameters out = p.life;
    out.landmarks = p.landmarks.life;
    return out;
}

AssociationParameters associationOf(const TargetParticleParameters& p) {
    AssociationParameters out;
    out.landmarks = LandmarkAssociation::nearest;  // none take part: particles find theirs themselves
    out.movers = p.association;
    out.gate_probability = p.landmarks.gate_probability;
    out.separation_probability = p.landmarks.separation_probability;
    return out;
}

std::vector<ParameterTable> describe(TargetParticleParameters& p, const std::string& name,
                                     const std::string& about) {
    ParameterTable filter(name, about);
    describe(p.particles, filter);
    filter
        .choice("proposal", p.particles.proposal,
                {{"motion", PoseProposal::motion}, {"refined", PoseProposal::refined}},
                "Where poses are drawn from. motion: the odometry alone (paper 2); refined: odometry and landmarks "
                "together, as in FastSLAM 2.0.")
        .choice("transform", p.particles.transform,
                {{"linear", GaussianTransform::linear}, {"unscented", GaussianTransform::unscented}},
                "How Gaussians of poses, landmarks and movers go through the sensor model: Jacobians or sigma points.")
        .flag("weigh_targets", p.weigh_targets,
              "Whether movers' detections weigh particles (paper 2). A wrong motion model of movers then harms the "
              "robot.");

    std::vector<ParameterTable> tables{filter};
    for (ParameterTable& table : describe(p.landmarks, name)) {
        if (table.section() == name + ".association")
            table.choice("movers", p.association,
                         {{"gnn", MoverAssociation::gnn},
                          {"jpda", MoverAssociation::jpda},
                          {"nearest", MoverAssociation::nearest},
                          {"known", MoverAssociation::known}},
                         "For detections without identity, at the moments over all particles. gnn: the likeliest "
                         "assignment of all; jpda: each mover is updated with all detections in its gate, weighed by "
                         "probability; nearest: each pair alone; known: they are ignored.");
        tables.push_back(std::move(table));
    }

    ParameterTable target(name + ".target", "Motion and life of movers.");
    target
        .choice("motion", p.drive, {{"modes", TargetDrive::modes}, {"control", TargetDrive::control}},
                "modes: position, velocity and acceleration by the models of [" + name +
                    ".modes]; control: position and heading, driven as [" + name + ".control] says (paper 2).")
        .real("velocity_std", p.velocity_std, "m/s", Interval::positive(),
              "Prior of each velocity component at first sight.")
        .real("acceleration_std", p.acceleration_std, "m/s^2", Interval::nonNegative(),
              "Prior of each acceleration component at first sight.")
        .real("max_unseen", p.max_unseen, "s", Interval::positiveOrInfinite(),
              "A track not seen for longer ends; inf keeps it.")
        .choice("outliers", p.outliers.treatment,
                {{"inflate", OutlierTreatment::inflate},
                 {"reject", OutlierTreatment::reject},
                 {"accept", OutlierTreatment::accept}},
                "Of detections of movers outside the gate. inflate: noise times (NIS / gate)^2; reject: not used; "
                "accept: used as if nothing were odd.")
        .real("outlier_probability", p.outliers.probability, "-", Interval::openProbability(),
              "Part of good detections that lie inside that gate.");
    describeMovers(p.life, target);
    ParameterTable modes(name + ".modes", "Modes of movers and how movers change between them.");
    describe(p.imm, modes);
    tables.push_back(target);
    tables.push_back(modes);
    tables.push_back(describe(p.control, name + ".control"));
    tables.push_back(describeMixed(p.life, name));
    return tables;
}

}  // namespace slamot

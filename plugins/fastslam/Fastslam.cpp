#include "Fastslam.h"

IMPLEMENTS_MRPT_OBJECT(Fastslam, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> Fastslam::onParameters() {
    ParameterTable filter(name(), "Particles with an EKF for each landmark.");
    filter.choice("version", particles_.proposal, {{"2", PoseProposal::refined}, {"1", PoseProposal::motion}},
                  "2: poses are drawn from motion and scan together (FastSLAM 2.0); 1: from the motion alone "
                  "(FastSLAM 1.0).");
    describe(particles_, filter);
    std::vector<ParameterTable> tables{describe(motion_), filter};
    for (ParameterTable& table : describe(landmarks_, name())) tables.push_back(std::move(table));
    return tables;
}

void Fastslam::onStart(const Start& start) {
    filter_ = std::make_unique<ParticleFilter<LandmarkFilters>>(
        particles_, motion_, LandmarkFilters::Settings(landmarks_, particles_.transform),
        ScanMaker(landmarks_.life, landmarks_.association != ParticleAssociation::known), start.threads);
    filter_->start(start.pose, start.seed);
}

}  // namespace slamot

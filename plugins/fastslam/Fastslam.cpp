#include "Fastslam.h"

IMPLEMENTS_MRPT_OBJECT(Fastslam, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> Fastslam::onParameters() {
    ParameterTable filter(name(), "Particles with an EKF for each landmark.");
    filter.choice("version", particles_.proposal, {{"2", PoseProposal::refined}, {"1", PoseProposal::motion}},
                  "2: poses are drawn from motion and scan together (FastSLAM 2.0); 1: from the motion alone "
                  "(FastSLAM 1.0).");
    describe(particles_, filter);
    return withMotion({filter}, describe(landmarks_, name()));
}

void Fastslam::onStart(const Start& start) {
    begin(start, particles_, motion(), LandmarkFilters::Settings(landmarks_, particles_.transform),
          ScanMaker(landmarks_.life, landmarks_.association != ParticleAssociation::known), start.threads);
}

}  // namespace slamot

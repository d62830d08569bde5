#include "Ufastslam.h"

IMPLEMENTS_MRPT_OBJECT(Ufastslam, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> Ufastslam::onParameters() {
    ParameterTable filter(name(), "Particles with an unscented filter for the pose and for each landmark (paper 4).");
    describe(particles_, filter);
    return withMotion({filter}, describe(landmarks_, name()));
}

void Ufastslam::onStart(const Start& start) {
    begin(start, particles_, motion(), LandmarkFilters::Settings(landmarks_, particles_.transform),
          ScanMaker(landmarks_.life, landmarks_.association != ParticleAssociation::known), start.threads);
}

}  // namespace slamot

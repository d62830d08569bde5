#include "Ufastslam.h"

IMPLEMENTS_MRPT_OBJECT(Ufastslam, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> Ufastslam::onParameters() {
    ParameterTable filter(name(), "Particles with an unscented filter for the pose and for each landmark (paper 4).");
    describe(particles_, filter);
    std::vector<ParameterTable> tables{describe(motion_), filter};
    for (ParameterTable& table : describe(landmarks_, name())) tables.push_back(std::move(table));
    return tables;
}

void Ufastslam::onStart(const Start& start) {
    filter_ = std::make_unique<ParticleFilter<LandmarkFilters>>(
        particles_, motion_, LandmarkFilters::Settings(landmarks_, particles_.transform),
        ScanMaker(landmarks_.life, landmarks_.association != ParticleAssociation::known), start.threads);
    filter_->start(start.pose, start.seed);
}

}  // namespace slamot

#include "PmbUfastslam.h"

IMPLEMENTS_MRPT_OBJECT(PmbUfastslam, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> PmbUfastslam::onParameters() {
    ParameterTable filter(name(), "Particles with a Poisson multi-Bernoulli map and unscented transforms.");
    describe(particles_, filter);
    std::vector<ParameterTable> tables{describe(motion_), filter};
    for (ParameterTable& table : describe(landmarks_, name())) tables.push_back(std::move(table));
    return tables;
}

void PmbUfastslam::onStart(const Start& start) {
    filter_ = std::make_unique<ParticleFilter<BernoulliMap>>(
        particles_, motion_, BernoulliMap::Settings(landmarks_, particles_.transform),
        ScanMaker(landmarks_.life, landmarks_.use_nameless), start.threads);
    filter_->start(start.pose, start.seed);
}

}  // namespace slamot

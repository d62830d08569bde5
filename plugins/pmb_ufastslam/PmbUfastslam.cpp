#include "PmbUfastslam.h"

IMPLEMENTS_MRPT_OBJECT(PmbUfastslam, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> PmbUfastslam::onParameters() {
    ParameterTable filter(name(), "Particles with a Poisson multi-Bernoulli map and unscented transforms.");
    describe(particles_, filter);
    return withMotion({filter}, describe(landmarks_, name()));
}

void PmbUfastslam::onStart(const Start& start) {
    begin(start, particles_, motion(), BernoulliMap::Settings(landmarks_, particles_.transform),
          ScanMaker(landmarks_.life, landmarks_.use_nameless), start.threads);
}

}  // namespace slamot

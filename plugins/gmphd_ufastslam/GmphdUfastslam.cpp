#include "GmphdUfastslam.h"

IMPLEMENTS_MRPT_OBJECT(GmphdUfastslam, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> GmphdUfastslam::onParameters() {
    ParameterTable filter(
        name(), "Particles with an unscented filter for the pose and a density for a map (paper 4).");
    describe(particles_, filter);
    return withMotion({filter, describe(map_, name())});
}

void GmphdUfastslam::onStart(const Start& start) {
    begin(start, particles_, motion(), PhdMap::Settings(map_, particles_.transform), ScanMaker(map_.clutter(), true),
          start.threads);
}

}  // namespace slamot

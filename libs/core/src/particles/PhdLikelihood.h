#pragma once
// What a scan says of a particle whose map is a probability hypothesis density.
#include "slamot/core/particles/PhdMap.h"

namespace slamot {

/// Log of the likelihood of what sensor `view` has detected from a known pose, given the density before, once
/// its update is worked out in `work`. Without what is the same for all particles.
double logLikelihood(const PhdMap::Settings& settings, const Vector3& pose, int view,
                     const PhdMap::Work& work);

}  // namespace slamot

#pragma once
// Probabilistic data association as one detection: what several detections, each with a probability, say of
// one object.
#include <vector>

#include "slamot/core/data/Pose2.h"

namespace slamot {

/// A detection that may come from an object whose measurement y = H x is N(0, P_y) about its prediction.
struct WeighedInnovation {
    double probability;
    Vector2 residual;
    Matrix2 noise;
};

struct MergedInnovation {
    Vector2 residual;
    Matrix2 noise;
};

/// The one innovation that takes N(0, P_y) to the mixture of the updates by each of `innovations` and of no
/// update at all, with what is left of the probabilities: to its mean exactly, and to its covariance as far as
/// a measurement can, which never adds to it. Where the mixture is as uncertain as before, or more, the noise
/// is `most_noise` times P_y. Bar-Shalom's PDA, for states of which y is but a part.
MergedInnovation mergedInnovation(const Matrix2& P_y, const std::vector<WeighedInnovation>& innovations,
                                  double most_noise = 20);

}  // namespace slamot

#pragma once
// What happens to a detection whose innovation is unlikely, in one mode or in several.
#include "slamot/core/data/Estimate.h"
#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

/// What happens to a detection whose innovation lies outside its gate.
enum class OutlierTreatment {
    accept,   ///< nothing: the plain filter
    inflate,  ///< its noise covariance is multiplied by (NIS / gate)^2
    reject    ///< it is not used
};

struct OutlierGate {
    OutlierTreatment treatment = OutlierTreatment::inflate;
    double probability = 0.999;

    /// Judges a detection by the mode that explains it best, so that a mover that changes its mode is no
    /// outlier, and treats it alike in all modes, so that their likelihoods stay comparable. Puts into
    /// `innovation` the moment-matched innovation over modes of probability mu, and the outcome; gives the
    /// noise to be added to that of the detection.
    Matrix2 judge(const Eigen::VectorXd& mu, const std::vector<Linearisation>& by_mode,
                  const RangeBearingDetection& detection, Innovation& innovation) const;
};

}  // namespace slamot

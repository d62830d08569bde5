#pragma once
// What a map as a probability hypothesis density takes for granted.
#include <string>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Angle.h"
#include "slamot/core/objects/Existence.h"

namespace slamot {

/// What a scan says of a particle.
enum class PhdLikelihood {
    set,            ///< Poisson: prod_z (c + sum P_D w q) exp(-sum P_D w)
    empty_map,      ///< Mullane et al.: Bayes' rule solved for the likelihood where no landmark is the map
    single_feature  ///< the same where the map is one landmark, the best known in view
};

enum class PhdBirths {
    unexplained,  ///< from detections that no component explains
    all           ///< from every detection (paper 4, step 2)
};

enum class PhdCorrection {
    once,  ///< the density's update is all that a detection does to the map
    twice  ///< landmarks are updated with their detections once more (paper 4, after step 5)
};

struct PhdMapParameters {
    double detection_probability = 0.95;   ///< P_D
    double clutter_per_scan = 1;           ///< lambda: false detections of a sensor, on average
    double new_per_scan = 0.05;            ///< first detections of landmarks, on average
    double largest_birth = 0.1;            ///< weight
    double range_margin = 0.6;             ///< [m]
    double bearing_margin = radians(4.6);  ///< [rad]
    double nearest = 0.3;                  ///< [m]; what is nearer is not missed
    double prune_below = 1e-3;             ///< weight
    double merge_within = 4;               ///< squared Mahalanobis distance
    double landmark_above = 0.5;           ///< weight
    double leave_below = 0.1;              ///< weight at which what is left behind is dropped
    PhdLikelihood likelihood = PhdLikelihood::set;
    PhdBirths births = PhdBirths::unexplained;
    PhdCorrection correction = PhdCorrection::once;

    /// min(largest_birth, new / (new + clutter)).
    double birthWeight() const;
    /// With this a ScanMaker gives each sight the density c(z) = lambda / ((r_max - r_min) field_of_view) of
    /// clutter. lambda is taken as 0.1 at least, so that c is never 0.
    LifeParameters clutter() const;
};

/// Table `[name.map]`.
ParameterTable describe(PhdMapParameters& parameters, const std::string& name);

}  // namespace slamot

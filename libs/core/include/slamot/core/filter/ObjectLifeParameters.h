#pragma once
// What objects without identity live by, in all filters.
#include <string>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/objects/Existence.h"
#include "slamot/core/objects/RelativeTrack.h"

namespace slamot {

enum class TrackBirth {
    one_point,  ///< nothing is known of a new mover's velocity
    two_point   ///< it has the velocity that its first detections show
};

struct ObjectLifeParameters {
    LifeParameters landmarks, movers;
    double merge_probability = 0.99;  ///< of two landmarks being one, at which they are merged

    TrackBirth birth = TrackBirth::two_point;
    double reidentify_within = 10;         ///< [s] after a track was lost
    double reidentify_probability = 0.99;  ///< gate of the lost track's prediction

    MotionChange change;
    double decide_probability = 0.9;  ///< P(moving) beyond which an object of unknown kind is a mover
};

/// Adds to the tables of landmarks and of movers.
void describeLandmarks(ObjectLifeParameters& parameters, ParameterTable& landmarks);
void describeMovers(ObjectLifeParameters& parameters, ParameterTable& movers);
/// The table `[name.mixed]`.
ParameterTable describeMixed(ObjectLifeParameters& parameters, const std::string& name);

}  // namespace slamot

#pragma once
// How detections come about: each object is detected or missed, everything else is clutter. What makes
// hypotheses with different numbers of pairs comparable.
#include <vector>

#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/data/Detections.h"

namespace slamot {

struct DetectionModel {
    /// By object: probability that it is detected, in [0, 1].
    std::vector<double> detection_probability;
    /// By detection: expected number of detections that come from none of the objects (false ones, and new
    /// objects), per unit of measurement: 1/(m rad) for range and bearing. Positive.
    std::vector<double> clutter_density;
    /// Probability that the detection of an object passes the gate; in (0, 1].
    double gate_probability = 1;
};

/// Density [1/(m rad)] of a Poisson number of false detections, `per_scan` on average, uniform in range and
/// bearing over what the sensor sees: per_scan / ((max_range - min_range) field_of_view). Throws
/// std::invalid_argument for a sensor without known limits.
double clutterDensity(double per_scan, const RangeBearingSensor& sensor);

/// For each candidate the log of how much likelier the batch is with this pair made than with its detection
/// clutter and its object missed: log(P_D N(nu; 0, S) / (c (1 - P_D P_G))), Blackman and Popoli's score.
/// Throws std::invalid_argument when sizes or values do not fit, or when P_D P_G = 1: then no pair could be
/// given up.
std::vector<double> logPairRatios(const AssociationProblem& problem, const DetectionModel& model);

}  // namespace slamot

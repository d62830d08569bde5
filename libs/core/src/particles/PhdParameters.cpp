#include "slamot/core/particles/PhdParameters.h"

#include <algorithm>

namespace slamot {
namespace {

constexpr double least_clutter = 0.1;

}  // namespace

double PhdMapParameters::birthWeight() const {
    const double all = new_per_scan + clutter_per_scan;
    return all > 0 ? std::min(largest_birth, new_per_scan / all) : largest_birth;
}

LifeParameters PhdMapParameters::clutter() const {
    LifeParameters life;
    life.clutter_per_scan = std::max(clutter_per_scan, least_clutter);
    life.new_per_scan = 0;
    return life;
}

ParameterTable describe(PhdMapParameters& p, const std::string& name) {
    ParameterTable map(name + ".map", "The map of a particle as a probability hypothesis density.");
    map.real("detection_probability", p.detection_probability, "-", Interval::openProbability(),
             "Of landmarks in view: part of the looks that detect them.")
        .real("clutter_per_scan", p.clutter_per_scan, "-", Interval::nonNegative(),
              "False detections of a sensor, on average; at least 0.1 is taken.")
        .real("new_per_scan", p.new_per_scan, "-", Interval::nonNegative(),
              "First detections of landmarks by a sensor, on average: a birth weighs new / (new + clutter).")
        .real("largest_birth", p.largest_birth, "-", Interval{0, 1, true, false},
              "What a birth weighs at most.")
        .choice(
            "births", p.births, {{"unexplained", PhdBirths::unexplained}, {"all", PhdBirths::all}},
            "unexplained: births from detections of which components explain less than half; all: from every "
            "detection.")
        .choice("likelihood", p.likelihood,
                {{"set", PhdLikelihood::set},
                 {"empty_map", PhdLikelihood::empty_map},
                 {"single_feature", PhdLikelihood::single_feature}},
                "Weight of a particle. set: the Poisson likelihood of all detections; empty_map, "
                "single_feature: Bayes' rule solved for it at a map of none or one landmark (Mullane et al.).")
        .choice("correction", p.correction, {{"once", PhdCorrection::once}, {"twice", PhdCorrection::twice}},
                "twice: landmarks are updated once more with the detection that the density took for them, "
                "as paper 4 prints it; over-confident.")
        .real("range_margin", p.range_margin, "m", Interval::nonNegative(),
              "Detections may come from so far beyond the sensor's range, misses count from so far within.")
        .real("bearing_margin_deg", p.bearing_margin, "deg", Interval::between(0, 180),
              "The same at the sides of the field of view.")
        .real("nearest", p.nearest, "m", Interval::nonNegative(), "What is nearer than this is not missed.")
        .real("prune_below", p.prune_below, "-", Interval{0, 1, true, true}, "Lighter terms are dropped.")
        .real("merge_within", p.merge_within, "-", Interval::nonNegative(),
              "Squared Mahalanobis distance, by its own covariance, within which a term joins a heavier one.")
        .real("landmark_above", p.landmark_above, "-", Interval{0, 1, true, true},
              "Components that weigh more are landmarks of the estimate.")
        .real("leave_below", p.leave_below, "-", Interval::probability(),
              "Components that weigh less are dropped once they are out of reach.");
    return map;
}

}  // namespace slamot

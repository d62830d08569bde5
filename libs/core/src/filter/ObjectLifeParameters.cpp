#include "slamot/core/filter/ObjectLifeParameters.h"

namespace slamot {

void describeLandmarks(ObjectLifeParameters& p, ParameterTable& landmarks) {
    describe(p.landmarks, "landmarks", landmarks);
    landmarks.real("merge_probability", p.merge_probability, "-", Interval::openProbability(),
                   "Of two landmarks being one, at which they are merged.");
}

void describeMovers(ObjectLifeParameters& p, ParameterTable& movers) {
    describe(p.movers, "movers", movers);
    movers
        .choice("birth", p.birth,
                {{"two_point", TrackBirth::two_point}, {"one_point", TrackBirth::one_point}},
                "two_point: a new mover has the velocity that the detections before its confirmation show; "
                "one_point: the prior, whatever they show.")
        .real("reidentify_within", p.reidentify_within, "s", Interval::nonNegative(),
              "A mover that comes back within that time after its track ended has its number again.")
        .real("reidentify_probability", p.reidentify_probability, "-", Interval::openProbability(),
              "Part of the movers that come back which lie inside the gate of the ended track's prediction.");
}

ParameterTable describeMixed(ObjectLifeParameters& p, const std::string& name) {
    ParameterTable mixed(name + ".mixed",
                         "Detections of which the sensor does not tell landmark from mover.");
    mixed
        .real("moving_probability", p.change.moving_probability, "-", Interval::openProbability(),
              "P(moving) of an object at first sight.")
        .real("start_every", p.change.start_every, "s", Interval::positiveOrInfinite(),
              "Time that a still object stays still, on average.")
        .real("stop_every", p.change.stop_every, "s", Interval::positiveOrInfinite(),
              "Time that a mover keeps moving, on average.")
        .real("velocity_std", p.change.velocity_std, "m/s", Interval::positive(),
              "Of each velocity component of what begins to move.")
        .real("decide_probability", p.decide_probability, "-", Interval{0.5, 1, true, true},
              "P(moving) above which an object becomes a mover; below 1 - this it becomes a landmark.");
    return mixed;
}

}  // namespace slamot

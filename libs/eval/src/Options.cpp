#include "slamot/eval/Options.h"

namespace slamot::eval {

const char* toText(Alignment alignment) {
    switch (alignment) {
        case Alignment::none:
            return "none";
        case Alignment::se2:
            return "se2";
        case Alignment::first_pose:
            return "first_pose";
    }
    return "";
}

const char* toText(RelativeUnit unit) {
    return unit == RelativeUnit::seconds ? "s" : "m";
}

const char* toText(Matching matching) {
    switch (matching) {
        case Matching::automatic:
            return "auto";
        case Matching::source_id:
            return "source_id";
        case Matching::assignment:
            return "assignment";
    }
    return "";
}

ParameterTable describe(EvaluationOptions& o) {
    ParameterTable table("eval", "How a run is compared with truth; formulae in doc/metrics.md.");
    table
        .real(
            "min_matched", o.min_matched, "", Interval::probability(),
            "least part of the estimates within truth's span that must have a truth; below it no trajectory "
            "metric is given")
        .choice("alignment", o.alignment,
                {{"none", Alignment::none}, {"se2", Alignment::se2}, {"first_pose", Alignment::first_pose}},
                "how the trajectory is laid on truth for the ATE; every other metric is unaligned")
        .real("rpe_delta", o.rpe_delta, "s or m", Interval::positive(),
              "time or path length over which the RPE is taken")
        .choice("rpe_unit", o.rpe_unit, {{"s", RelativeUnit::seconds}, {"m", RelativeUnit::metres}},
                "unit of rpe_delta")
        .real("probability", o.probability, "", Interval::openProbability(),
              "of chi-square bands and of coverage")
        .choice("landmark_matching", o.landmark_matching,
                {{"auto", Matching::automatic},
                 {"source_id", Matching::source_id},
                 {"assignment", Matching::assignment}},
                "how estimated landmarks find their truth; auto takes source ids if there are any")
        .real("landmark_cutoff", o.landmark_cutoff, "m", Interval::positive(),
              "largest distance of a pair when landmarks are matched by assignment")
        .real("set_order", o.set_order, "", Interval::atLeast(1), "order p of OSPA, GOSPA and T-GOSPA")
        .real("set_cutoff", o.set_cutoff, "m", Interval::positive(), "cutoff c of OSPA, GOSPA and T-GOSPA")
        .real("switch_penalty", o.switch_penalty, "m", Interval::positive(),
              "what T-GOSPA asks for a target that goes on with another track")
        .real("target_gate", o.target_gate, "m", Interval::positive(),
              "largest distance of a track from the target it follows, for MOTA, MOTP, IDF1 and their like")
        .real("min_existence", o.min_existence, "", Interval::probability(),
              "tracks less likely to exist are left out of OSPA, GOSPA, T-GOSPA, MOTA, IDF1 and cardinality");
    return table;
}

}  // namespace slamot::eval

#pragma once
#include "slamot/core/config/Parameters.h"

namespace slamot::eval {

/// How the estimated trajectory is brought into the truth's frame before the absolute trajectory error is
/// taken.
enum class Alignment {
    none,
    se2,         ///< the rotation and shift of least squares over all positions, no scale
    first_pose,  ///< the first matched pose laid on its truth
};
const char* toText(Alignment alignment);

/// What the distance between two poses of the relative pose error is measured in.
enum class RelativeUnit { seconds, metres };
const char* toText(RelativeUnit unit);

/// How estimated and true objects are paired.
enum class Matching {
    automatic,   ///< by source id if any estimate carries one, else by assignment
    source_id,   ///< estimate and truth carry the same id of the log
    assignment,  ///< least total distance, within a cutoff
};
const char* toText(Matching matching);

/// Section `[eval]`: how a run is compared with truth. Formulae in doc/metrics.md.
struct EvaluationOptions {
    double min_matched = 0.5;  ///< least part of the estimates within truth's span that must have a truth
    Alignment alignment = Alignment::se2;
    double rpe_delta = 1.0;  ///< [s] or [m]
    RelativeUnit rpe_unit = RelativeUnit::seconds;
    double probability = 0.95;  ///< of chi-square bands and of coverage
    Matching landmark_matching = Matching::automatic;
    double landmark_cutoff = 2.0;  ///< [m], matching by assignment
    double set_order = 2.0;        ///< p of OSPA, GOSPA and T-GOSPA
    double set_cutoff = 5.0;       ///< c of OSPA, GOSPA and T-GOSPA [m]
    double switch_penalty = 2.0;   ///< gamma of T-GOSPA [m]
    double target_gate = 2.0;    ///< [m], largest distance of a track from the target it follows: MOTA, IDF1
    double min_existence = 0.5;  ///< tracks below are not part of the set of targets
};
ParameterTable describe(EvaluationOptions& options);

}  // namespace slamot::eval

#pragma once
#include "slamot/eval/Consistency.h"
#include "slamot/eval/ErrorSummary.h"
#include "slamot/eval/Measured.h"
#include "slamot/eval/Options.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::eval {

/// The map at the end of the run against the true landmarks, in the world frame, unaligned.
struct LandmarkErrors {
    /// How they were paired: source_id or assignment.
    Matching matching = Matching::source_id;
    /// True landmarks with an estimate; true landmarks without one (seen or not); estimates without a truth.
    std::int64_t matched = 0, missing = 0, extra = 0;
    ErrorSummary position;
    Measured<NeesSummary> nees;
};

Measured<LandmarkErrors> landmarkErrors(const RunRecord& run, const Truth& truth,
                                        const EvaluationOptions& options);

/// Number of landmarks in the map at the end of the run minus number of true ones.
struct MapCardinality {
    std::int64_t estimated = 0, landmarks = 0, error = 0;
    /// Against those alone that a detection came from while the run lasted, as truth's associations tell.
    struct Seen {
        std::int64_t landmarks = 0, error = 0;
    };
    Measured<Seen> seen;
};
Measured<MapCardinality> mapCardinality(const RunRecord& run, const Truth& truth);

}  // namespace slamot::eval

#pragma once
// Which detections went to the right object: recall and precision of data association.
#include <cstdint>
#include <limits>

#include "slamot/eval/Measured.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::eval {

struct AssociationScores {
    /// Detections that have a true source, undecided ones left out; those of them that went into the object
    /// that stands for it.
    std::int64_t detections = 0, found = 0;
    /// Undecided: detections that have a true source for which nothing in the estimate stands yet, and are
    /// tentative. Neither right nor wrong.
    std::int64_t tentative = 0;
    /// Detections that went into an object; those of them whose source the object stands for; those that are
    /// clutter.
    std::int64_t associated = 0, right = 0, clutter = 0;
    /// found / detections and right / associated; NaN where there is nothing to divide by.
    double recall = std::numeric_limits<double>::quiet_NaN(), precision = recall;
};

struct AssociationMetrics {
    AssociationScores all;
    /// Recall of detections of true landmarks, precision of what went into estimated landmarks; likewise
    /// movers and tracks.
    AssociationScores landmarks, movers;
    /// Clutter that is tentative: not taken for a thing.
    std::int64_t tentative_clutter = 0;
    /// Landmarks in the map at the end that stand for what another one in it stands for: all but one of each.
    std::int64_t doubled_landmarks = 0;
    /// Detections used, tentative ones included; and those left out: at stamps where the log had fewer
    /// detections than truth has, so that their numbers do not fit, or where truth says nothing of their
    /// source.
    std::int64_t used = 0, without_truth = 0, unnumbered = 0;
};

/// False detections that the run itself added are clutter wherever truth knows all others of their stamp.
/// An object stands for the true source that most of its detections came from, of equals the one that came
/// first; clutter is no source. Of several objects that stand for one source, the one with the most
/// detections of it is the object that a detection should be found in, of equals the one that had its first.
Measured<AssociationMetrics> associationMetrics(const RunRecord& run, const Truth& truth);

}  // namespace slamot::eval

#pragma once
// What has been detected and may be an object: kept beside the joint state until its existence is confirmed,
// so that clutter neither costs nor disturbs the estimate.
#include <vector>

#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/objects/Existence.h"
#include "slamot/core/objects/RelativeTrack.h"

namespace slamot {

struct TentativeObject {
    ObjectKind kind;  ///< of its detections; unknown: P(moving) decides what it becomes
    Existence existence;
    RelativeTrack track;
    int seen = 1;
    Stamp first_seen;
};

/// One that is confirmed, by a detection of the present batch.
struct ConfirmedObject {
    int detection;  ///< number in the batch
    bool moving;
    TentativeObject object;
};

struct TentativeParameters {
    LifeParameters landmarks, movers;  ///< an object of unknown kind lives as a landmark
    MotionChange change;
    /// P(moving) beyond which an object of unknown kind is a mover, and below 1 - this a landmark.
    double decide_probability = 0.9;
    double gate_probability = 0.999;
    double velocity_std = 3, acceleration_std = 2;  ///< of a mover at first sight
};

class TentativeObjects {
  public:
    explicit TentativeObjects(const TentativeParameters& parameters);

    void clear() { objects_.clear(); }
    int size() const { return static_cast<int>(objects_.size()); }
    const std::vector<TentativeObject>& objects() const { return objects_; }

    void predict(const RelativeStep& step, const TargetModel& model);

    /// Takes in what no object of the estimate explains: `unexplained`, numbers of detections, ascending; those
    /// flagged in `may_start` (by number of detection) start an object when no tentative one explains them.
    /// Assigns by globalNearestNeighbour. The confirmed leave, in the order of their detections.
    std::vector<ConfirmedObject> update(const RangeBearingSet& seen, Stamp now,
                                        const std::vector<int>& unexplained,
                                        const std::vector<bool>& may_start, Consistency consistency);

  private:
    TentativeParameters parameters_;
    PairGates gates_;
    std::vector<TentativeObject> objects_;
};

}  // namespace slamot

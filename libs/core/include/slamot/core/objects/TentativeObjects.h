#pragma once
// What has been detected and may be an object: kept beside the joint state until its existence is confirmed,
// so that clutter neither costs nor disturbs the estimate. doc/maths/objects.md.
#include <optional>
#include <vector>

#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/association/DetectionModel.h"
#include "slamot/core/objects/Existence.h"
#include "slamot/core/objects/RelativeTrack.h"

namespace slamot {

/// A detection of an object, to be taken in when the object is confirmed.
struct TentativeSight {
    Stamp at;
    RangeBearingDetection detection;
    Pose2 sensor;
    double unexplained;  ///< density [1/(m rad)] of what else it may have been
};

struct TentativeObject {
    ObjectKind kind;  ///< of its detections; unknown: P(moving) decides what it becomes
    Existence existence;
    RelativeTrack track;
    int seen = 1;  ///< detections
    Stamp first_seen, last_seen;
    std::vector<TentativeSight> sights;  ///< the latest, oldest first

    /// Objects that take longer to confirm lose their first sights.
    static constexpr std::size_t most_sights = 20;
    void keep(const TentativeSight& sight);
};

/// Density [1/(m rad)] of what a sensor detects that comes from no known object: clutter, and first sights.
/// Never 0, also where neither is expected: every detection has some source.
double unexplainedDensity(const LifeParameters& life, const RangeBearingSensor& sensor);
/// By number of detection; of unknown kind counts as landmarks.
std::vector<double> unexplainedDensities(const LifeParameters& landmarks, const LifeParameters& movers,
                                         const RangeBearingSet& seen);

/// One that is confirmed, by a detection of the present batch.
struct ConfirmedObject {
    int detection;  ///< number in the batch: its last one there
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
    /// [s]; one not detected for longer is let go wherever it is: those that left the view get no misses, and
    /// would gather without end.
    double max_unseen = 5;
};

class TentativeObjects {
  public:
    explicit TentativeObjects(const TentativeParameters& parameters);

    void clear() { objects_.clear(); }
    int size() const { return static_cast<int>(objects_.size()); }
    const std::vector<TentativeObject>& objects() const { return objects_; }

    void predict(const RelativeStep& step, const TargetModel& model);

    /// Takes in what no object of the estimate explains: `unexplained`, numbers of detections, ascending;
    /// those flagged in `may_start` (by number of detection) start an object when no tentative one explains
    /// them. Sensor by sensor, each by globalNearestNeighbour; a detection of unknown kind may be of any
    /// object, else kinds agree. The confirmed leave when it is known whether they move, in the order of
    /// their detections. Sensors have a known max_range.
    std::vector<ConfirmedObject> update(const RangeBearingSet& seen, Stamp now,
                                        const std::vector<int>& unexplained,
                                        const std::vector<bool>& may_start, Consistency consistency);

  private:
    struct Batch;
    /// One sensor's part of a batch: detections of tentative objects, misses, first sights.
    void look(int sensor, const Batch& batch, std::vector<int>& detection_of);
    /// How likely objects are detected, and how dense the detections are that come from none of them.
    DetectionModel detectionModel(const Batch& batch, const std::vector<int>& detections) const;
    /// Pairs within the gate; detections by their place in the list.
    AssociationProblem candidates(const Batch& batch, const std::vector<int>& detections,
                                  const std::vector<ExpectedDetection>& expected);
    /// False where no new objects are expected.
    bool start(int detection, const Batch& batch);
    std::vector<ConfirmedObject> takeConfirmed(const std::vector<int>& detection_of);
    const LifeParameters& lifeOf(ObjectKind kind) const {
        return kind == ObjectKind::mover ? parameters_.movers : parameters_.landmarks;
    }
    /// Whether it moves, where that is decided.
    std::optional<bool> moves(const TentativeObject& object) const;

    TentativeParameters parameters_;
    PairGates gates_;
    Stamp last_update_;
    std::vector<TentativeObject> objects_;
};

}  // namespace slamot

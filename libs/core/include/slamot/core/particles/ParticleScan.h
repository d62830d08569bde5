#pragma once
// One batch of detections as all particles look at it: what does not depend on a particle is worked out once.
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/filter/SensorLimits.h"
#include "slamot/core/objects/Existence.h"
#include "slamot/core/particles/PointSight.h"

namespace slamot {

/// A detection of what may be a landmark.
struct ScanSight {
    int detection;    ///< index in the batch
    Vector2 z;        ///< [range bearing]
    Matrix2 R;        ///< its noise
    Vector2 local;    ///< where it points to, in the robot's frame [m]
    int view;         ///< index among the scan's views
    SourceId source;  ///< valid where the log says what it is
    /// Named: the landmark's number, the same in all particles; none at its first sight, or where there is no
    /// name.
    LandmarkId known_as;
    /// The number that what it starts has in every particle: one for each detection of a run, so that what
    /// particles started with the same detection has the same number in all of them.
    LandmarkId birth;
    double log_unexplained;  ///< log of the density [1/(m rad)] of detections that come from nothing known
    bool may_be_mover;  ///< of unknown kind, in a filter that has movers: it starts no landmark by itself

    bool named() const { return source.valid(); }
};

/// A sensor as it looks now.
struct ScanView {
    RangeBearingSensor sensor;
    double reach;   ///< [m] from the robot's origin within which it detects anything
    bool nameless;  ///< it detects what has no identity: what it misses speaks against that
};

struct ParticleScan {
    Stamp now;
    std::vector<ScanSight> sights;  ///< view after view; their numbers at birth ascend
    std::vector<ScanView> views;
    double reach = 0;                    ///< [m], the largest of the views'
    bool nameless = false;               ///< whether any view is
    bool fixes_poses = false;            ///< poses are to be drawn even if nothing here is of the map
    std::vector<double> visible_movers;  ///< by mover: probability that it is there and not hidden

    const ScanView& viewOf(const ScanSight& sight) const {
        return views[static_cast<std::size_t>(sight.view)];
    }
    const Pose2& sensorOf(const ScanSight& sight) const { return viewOf(sight).sensor.pose; }
    /// The sensors in the world, by view.
    void placesFrom(const Vector3& pose, std::vector<SensorPlace>& places) const {
        places.clear();
        for (const ScanView& view : views) places.push_back(placeOf(pose, view.sensor.pose));
    }
};

/// Makes scans of batches, and remembers what that takes.
class ScanMaker {
  public:
    /// use_nameless: whether detections without identity are taken in at all; movers: whether one of unknown
    /// kind may be of a mover.
    ScanMaker(const LifeParameters& life, bool use_nameless, bool movers = false)
        : life_(life), use_nameless_(use_nameless), movers_(movers) {}

    void clear() { *this = ScanMaker(life_, use_nameless_, movers_); }
    ParticleScan scan(const DetectionSet& set);
    /// For a landmark that all particles are given at once: above all numbers so far.
    LandmarkId freshNumber() { return {detections_++}; }

  private:
    LifeParameters life_;
    bool use_nameless_, movers_;
    SensorLimits limits_;
    std::set<std::string> nameless_;  ///< labels of sensors that have detected what has no identity
    std::unordered_map<SourceId, LandmarkId> named_;
    std::int64_t detections_ = 0;
};

/// What became of a sight in one particle.
struct SightRecord {
    Outcome outcome = Outcome::ignored;
    LandmarkId landmark;
    Vector2 z = Vector2::Zero();      ///< expected, at the predicted pose
    Matrix2 S = Matrix2::Identity();  ///< innovation covariance there
    bool may_be_new = false;          ///< nothing that the particle knows explains it, or could
};

}  // namespace slamot

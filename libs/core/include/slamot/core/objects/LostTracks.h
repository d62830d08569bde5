#pragma once
// Tracks that ended unseen, for a while: one that comes out of an occlusion is known again.
#include <optional>
#include <vector>

#include "slamot/core/association/ChiSquare.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/models/TargetMotion.h"

namespace slamot {

struct LostTrack {
    TrackId id;
    Vector6 mean;
    Matrix6 covariance;
    Stamp at;  ///< when it was lost
};

class LostTracks {
  public:
    /// gate_probability: that a mover which comes back lies within the gate of its own prediction;
    /// keep_for: [s], from when it was lost.
    LostTracks(double gate_probability, double keep_for);

    void clear() { tracks_.clear(); }
    void add(const LostTrack& track) { tracks_.push_back(track); }
    /// They move on unseen, step by step as tracks do: what is driven by one draw of noise a step spreads less
    /// than by one draw for all the time.
    void predict(double dt, const TargetModel& model);
    /// Lets go of those lost for longer than keep_for before `now`.
    void forgetOld(Stamp now);

    /// The track that a new mover of that mean and covariance continues, which leaves; none where no lost one
    /// fits, or where it could be another as well (more than one within the gate). Positions and velocities are
    /// compared; both estimates count as independent.
    std::optional<TrackId> continuedBy(const Vector6& mean, const Matrix6& covariance);
    bool empty() const { return tracks_.empty(); }

  private:
    double gate_, keep_for_;
    std::vector<LostTrack> tracks_;
};

}  // namespace slamot

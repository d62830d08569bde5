#pragma once
// Figures of a run step by step, by name: what `series` of a study file may list.
//
// robot_nees      squared error of the robot's pose weighted by its covariance, with its dimension
// robot_error     distance of the robot's position from truth [m]
// heading_error   estimate minus truth, wrapped [rad]
// target_error    distance of the target's position from truth [m]
// target_nees     squared error of the target's position weighted by its covariance, with its dimension
// landmark_count  landmarks in the map
// landmark_error_by_age  root mean square distance from truth [m] of the landmarks detected at that age; its
//                 seconds are the age, since a landmark was first seen
// p_<mode>        probability of a motion mode of the target's track, for estimators that have that mode
//
// The target is the one of lowest id in the truth; its track is the one with that source id or, where no
// track has a source id, the one of highest existence.
#include <map>
#include <string>
#include <vector>

#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"
#include "slamot/run/Sink.h"
#include "slamot/study/Row.h"

namespace slamot::study {

/// Throws ConfigError, naming the place and the nearest name, for one that is not known.
void requireKnownSeries(const std::vector<std::string>& names, const std::string& origin);

/// Whether it has dimensions, and so a chi-square band.
bool isNeesSeries(const std::string& name);

/// A landmark's estimate after a detection of it.
struct LandmarkSight {
    Stamp stamp;
    LandmarkEstimate landmark;
};

/// What no RunRecord keeps of the landmarks: their number at every stamp and, where a series of them is
/// asked for, every sight.
class LandmarkHistory : public run::Sink {
  public:
    explicit LandmarkHistory(const std::vector<std::string>& series);
    void step(const run::Step& step) override;
    const std::map<Stamp, std::int64_t>& counts() const { return counts_; }
    const std::vector<LandmarkSight>& sights() const { return sights_; }

  private:
    bool keeps_sights_;
    std::map<Stamp, std::int64_t> counts_;
    std::vector<LandmarkSight> sights_;
};

/// The series asked for that this run has; `truth` may be null.
std::map<std::string, Series> seriesOf(const std::vector<std::string>& names, const eval::RunRecord& record,
                                       const LandmarkHistory& landmarks, const Truth* truth);

}  // namespace slamot::study

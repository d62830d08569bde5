#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "OverviewView.h"
#include "slamot/report/RunFolder.h"

namespace slamot::report {

/// What the layers of a replay share: which steps are its frames, the view, and the numbers that landmarks
/// and tracks have in it. At most 2000 frames evenly over the time, and so many places of landmarks that the
/// page stays small however long the run was.
class ReplayScene {
  public:
    explicit ReplayScene(const RunFolder& run);

    const RunFolder& run;
    /// Rows of the trajectory, and their stamps.
    const std::vector<std::size_t>& frames() const { return frames_; }
    const std::vector<Stamp>& stamps() const { return stamps_; }
    const MapView& view() const { return view_; }
    /// After the point that lengths are given with.
    int digits() const { return digits_; }

    /// Columns "frame", "index", "x", "y", "a", "b", "angle": the places of landmarks in the order of time; a
    /// null place is where one goes. "count" landmarks have indices from 0. "existence" [%] where one is in doubt.
    const nlohmann::json& landmarks() const { return landmarks_; }
    /// A list: name, colour, first frame, columns from there on.
    const nlohmann::json& tracks() const { return tracks_; }
    /// What was used at each frame: landmarks by their index, tracks as -1 minus theirs. Evenly thinned where
    /// it is very much.
    const nlohmann::json& seen() const { return seen_; }
    /// Columns "from" and "to" (the frame after the last), "x", "y", "existence" [%]: what may be a landmark.
    const nlohmann::json& tentative() const { return tentative_; }
    /// Columns "x", "y" [units from the robot], "theta" [0.01 rad], "weight" (9 is the heaviest of its frame); those of
    /// frame i begin at "first"[i]; "unit" [m].
    const nlohmann::json& particles() const { return particles_; }
    /// What was left out, in sentences.
    const std::vector<std::string>& cuts() const { return cuts_; }

  private:
    void findView();
    std::size_t frameOf(Stamp stamp) const;
    void makeLandmarks();
    void makeTracks();
    void makeSeen();
    void makeTentative();
    void makeParticles();

    std::vector<std::size_t> frames_;
    std::vector<Stamp> stamps_;
    MapView view_;
    double pixel_ = 1;
    int digits_ = 3;
    nlohmann::json landmarks_, tracks_, seen_, tentative_, particles_;
    std::vector<std::string> cuts_;
    std::map<TrackId, std::size_t> track_index_;
    std::map<LandmarkId, std::size_t> landmark_index_;
};

/// Of landmarks, and of what may be one.
inline constexpr std::size_t most_places = 30000;
/// A change of existence that is seen.
inline constexpr double visible_existence = 0.05;

/// The places of landmarks over time that are kept of `sights`: one for each change that is seen at `pixel`
/// metres a pixel, or of existence; the first and last of each landmark in any case.
std::vector<LandmarkSight> visibleChanges(const std::vector<LandmarkSight>& sights, double pixel);

/// Which of `count` things are shown where at most `most` are, spread evenly.
inline bool isKept(std::size_t index, std::size_t count, std::size_t most) {
    return count <= most || (index + 1) * most / count > index * most / count;
}

}  // namespace slamot::report

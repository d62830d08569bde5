#include "sections/ReplayData.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "OverviewView.h"
#include "TrackStyles.h"
#include "page/CompactSpec.h"

namespace slamot::report {
namespace {

using nlohmann::json;

constexpr std::size_t most_frames = 2000, most_places = 30000, most_sights = 60000;
constexpr double map_pixels = 900;  // about the width of the picture

/// Half axes at three standard deviations, and the angle of the longer one.
struct Axes {
    double a = 0, b = 0, angle = 0;
};

Axes axesOf(const Matrix2& covariance) {
    const Eigen::SelfAdjointEigenSolver<Matrix2> eigen(covariance);
    const Vector2 along = eigen.eigenvectors().col(1);
    return {3 * std::sqrt(std::max(0.0, eigen.eigenvalues()(1))),
            3 * std::sqrt(std::max(0.0, eigen.eigenvalues()(0))), std::atan2(along.y(), along.x())};
}

/// Columns of numbers for JavaScript, with as many digits as can be seen after zooming in twenty times.
class Columns {
  public:
    explicit Columns(int digits) : digits_(digits) {}
    void length(const char* name, double value) { add(name, value, digits_); }
    void angle(double value) { add("angle", value, 2); }
    void add(const char* name, double value, int digits) {
        json& column = columns_[name];
        if (column.is_null()) {
            column = json::array();
        }
        std::isfinite(value) ? column.push_back(rounded(value, digits)) : column.push_back(nullptr);
    }
    void point(const Vector2& p) {
        length("x", p.x());
        length("y", p.y());
    }
    void ellipse(const Matrix2& covariance) {
        const Axes axes = axesOf(covariance);
        length("a", axes.a);
        length("b", axes.b);
        angle(axes.angle);
    }
    void unknown(std::initializer_list<const char*> names) {
        for (const char* name : names) {
            add(name, std::nan(""), 0);
        }
    }
    void whole(const char* name, std::int64_t value) { columns_[name].push_back(value); }
    json& take() { return columns_; }

  private:
    int digits_;
    json columns_ = json::object();
};

/// Rows of the trajectory that become frames: the last one in each of equal spans of time.
std::vector<std::size_t> framesOf(const RunFolder& run) {
    const auto& rows = run.run.trajectory;
    std::vector<std::size_t> frames;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto span = [&](std::size_t k) {
            return std::floor(run.seconds(rows[k].stamp) / run.duration() * (most_frames - 1));
        };
        if (rows.size() <= most_frames || i + 1 == rows.size() || span(i + 1) > span(i)) {
            frames.push_back(i);
        }
    }
    return frames;
}

class Writer {
  public:
    explicit Writer(const RunFolder& run) : run_(run), frames_(framesOf(run)) {
        findView();
        digits_ = static_cast<int>(std::ceil(-std::log10(pixel_ / 20)));
        for (const std::size_t frame : frames_) {
            stamps_.push_back(run.run.trajectory[frame].stamp);
        }
    }

    std::string text() {
        json data = {{"low", {view_.low.x(), view_.low.y()}}, {"high", {view_.high.x(), view_.high.y()}}};
        data["colours"] = {{"robot", colour::blue},
                           {"landmark", colour::black},
                           {"trueLandmark", colour::grey},
                           {"sight", colour::sky}};
        data["times"] = json::array();
        for (const Stamp stamp : stamps_) {
            data["times"].push_back(rounded(run_.seconds(stamp), 3));
        }
        data["modes"] = json::array();
        for (std::size_t m = 0; m < run_.run.mode_names.size(); ++m) {
            data["modes"].push_back({{"name", run_.run.mode_names[m]}, {"colour", seriesStyle(m).colour}});
        }
        data["robot"] = robot();
        data["tracks"] = tracks();
        data["landmarks"] = landmarks();
        data["landmarkCount"] = landmarkCounts();
        data["seen"] = seen();
        data["sensors"] = sensors();
        addTruth(data);
        return data.dump();
    }

  private:
    /// The map with room at its rim.
    void findView() {
        Points2 ways, objects;
        for (const eval::RobotRow& row : run_.run.trajectory) {
            ways.push_back(row.robot.mean.position());
        }
        for (const auto& [stamp, tracks] : run_.run.tracks) {
            for (const TrackEstimate& track : tracks) {
                objects.push_back(track.mean.head<2>());
            }
        }
        for (const LandmarkEstimate& landmark : run_.run.landmarks) {
            objects.push_back(landmark.mean);
        }
        view_ = mapView(ways, objects);
        const Vector2 rim = 0.04 * (view_.high - view_.low).maxCoeff() * Vector2::Ones();
        view_.low -= rim;
        view_.high += rim;
        pixel_ = (view_.high - view_.low).maxCoeff() / map_pixels;
    }

    std::size_t frameOf(Stamp stamp) const {
        const auto at = std::lower_bound(stamps_.begin(), stamps_.end(), stamp);
        return std::min(static_cast<std::size_t>(at - stamps_.begin()), stamps_.size() - 1);
    }

    json robot() const {
        Columns columns(digits_);
        for (const std::size_t frame : frames_) {
            const PoseGaussian& pose = run_.run.trajectory[frame].robot;
            columns.point(pose.mean.position());
            columns.add("theta", pose.mean.theta, 3);
            columns.ellipse(pose.covariance.topLeftCorner<2, 2>());
        }
        return columns.take();
    }

    json tracks() {
        json all = json::array();
        std::map<TrackId, Columns> columns;
        std::map<TrackId, std::size_t> from;
        for (std::size_t f = 0; f < stamps_.size(); ++f) {
            const auto present = run_.run.tracks.find(stamps_[f]);
            std::set<TrackId> here;
            if (present != run_.run.tracks.end()) {
                for (const TrackEstimate& track : present->second) {
                    from.try_emplace(track.id, f);
                    Columns& of_track = columns.try_emplace(track.id, digits_).first->second;
                    fillGap(of_track, f - from[track.id]);
                    of_track.point(track.mean.head<2>());
                    of_track.ellipse(track.covariance.topLeftCorner<2, 2>());
                    const auto& p = track.mode_probabilities;
                    of_track.whole("mode", std::max_element(p.begin(), p.end()) - p.begin());
                }
            }
        }
        for (const StyledTrack& track : styledTracks(run_.run)) {
            const auto found = columns.find(track.id);
            if (found == columns.end()) {
                continue;  // it lived between two frames
            }
            json entry = found->second.take();
            entry["name"] = nameOf(track);
            entry["colour"] = track.style.colour;
            entry["from"] = from[track.id];
            track_index_[track.id] = all.size();
            all.push_back(std::move(entry));
        }
        return all;
    }

    /// Frames without the track since it was last there.
    static void fillGap(Columns& columns, std::size_t wanted) {
        while (columns.take().contains("x") && columns.take()["x"].size() < wanted) {
            columns.unknown({"x", "y", "a", "b", "angle"});
            columns.whole("mode", 0);
        }
    }

    json landmarks() {
        double pixel = pixel_ / 2;
        std::vector<LandmarkSight> places = visibleChanges(run_.sights, pixel);
        for (int tries = 0; places.size() > most_places && tries < 10; ++tries) {
            pixel *= 2;
            places = visibleChanges(run_.sights, pixel);
        }
        if (places.empty()) {  // no history: the map of the end, from when each was first seen
            for (const LandmarkEstimate& l : run_.run.landmarks) {
                places.push_back({l.first_seen, l.id, l.source, l.mean, l.covariance});
            }
            std::sort(places.begin(), places.end(),
                      [](const LandmarkSight& a, const LandmarkSight& b) { return a.stamp < b.stamp; });
        }
        std::set<LandmarkId> kept;
        for (const LandmarkEstimate& l : run_.run.landmarks) {
            kept.insert(l.id);
        }
        std::map<LandmarkId, std::size_t> last;
        for (std::size_t i = 0; i < places.size(); ++i) {
            last[places[i].id] = i;
        }
        Columns columns(digits_);
        json result = {{"frame", json::array()}, {"index", json::array()}, {"x", json::array()},
                       {"y", json::array()},     {"a", json::array()},     {"b", json::array()},
                       {"angle", json::array()}};
        for (std::size_t i = 0; i < places.size(); ++i) {
            const LandmarkSight& place = places[i];
            const std::size_t index =
                landmark_index_.try_emplace(place.id, landmark_index_.size()).first->second;
            const auto frame = static_cast<std::int64_t>(frameOf(place.stamp));
            columns.whole("frame", frame);
            columns.whole("index", static_cast<std::int64_t>(index));
            columns.point(place.mean);
            columns.ellipse(place.covariance);
            if (last[place.id] == i && kept.count(place.id) == 0) {
                // Merged or removed since: nothing says when, so it goes after it was last seen.
                columns.whole("frame", frame + 1);
                columns.whole("index", static_cast<std::int64_t>(index));
                columns.unknown({"x", "y", "a", "b", "angle"});
            }
        }
        result.update(columns.take());
        result["count"] = landmark_index_.size();
        return result;
    }

    /// Landmarks in the estimate at each frame; empty where steps.csv is not there.
    json landmarkCounts() const {
        json counts = json::array();
        std::size_t row = 0;
        for (const Stamp stamp : stamps_) {
            while (row + 1 < run_.steps.size() && run_.steps[row + 1].stamp <= stamp) {
                ++row;
            }
            if (!run_.steps.empty()) {
                counts.push_back(run_.steps[row].landmarks);
            }
        }
        return counts;
    }

    /// What was used at each frame: landmarks by their index, tracks as -1 minus theirs.
    json seen() const {
        std::map<Stamp, std::size_t> frame_at;
        for (std::size_t f = 0; f < stamps_.size(); ++f) {
            frame_at[stamps_[f]] = f;
        }
        json frames = json::array();
        for (std::size_t f = 0; f < stamps_.size(); ++f) {
            frames.push_back(json::array());
        }
        std::size_t count = 0;
        for (const eval::InnovationRow& row : run_.run.innovations) {
            const auto frame = frame_at.find(row.stamp);
            if (frame == frame_at.end() || count == most_sights) {
                continue;
            }
            const auto landmark = landmark_index_.find(row.innovation.landmark);
            const auto track = track_index_.find(row.innovation.track);
            if (track != track_index_.end()) {
                frames[frame->second].push_back(-1 - static_cast<std::int64_t>(track->second));
                ++count;
            } else if (landmark != landmark_index_.end()) {
                frames[frame->second].push_back(landmark->second);
                ++count;
            }
        }
        return frames;
    }

    json sensors() const {
        json all = json::array();
        for (const auto& sensor : run_.summary.value("sensors", json::array())) {
            all.push_back({{"x", sensor.value("x", 0.0)},
                           {"y", sensor.value("y", 0.0)},
                           {"theta", sensor.value("theta", 0.0)},
                           {"range", sensor.value("max_range", 0.0)},
                           {"view", sensor.value("field_of_view", 0.0)}});
        }
        return all;
    }

    void addTruth(json& data) const {
        data["truth"] = nullptr;
        data["targets"] = json::array();
        data["trueLandmarks"] = {{"x", json::array()}, {"y", json::array()}};
        if (!run_.truth) {
            return;
        }
        const Vector2 unknown = Vector2::Constant(std::nan(""));
        Columns robot(digits_), landmarks(digits_);
        for (const Stamp stamp : stamps_) {
            const auto pose = run_.truth->pointAt(stamp);
            robot.point(pose ? pose->position() : unknown);
        }
        data["truth"] = robot.take();
        std::map<SourceId, std::string> colours;
        for (const StyledTrack& track : styledTracks(run_.run)) {
            colours.try_emplace(track.source, track.style.colour);
        }
        for (const auto& [id, samples] : run_.truth->targets) {
            Columns target(digits_);
            for (const Stamp stamp : stamps_) {
                const auto sample = run_.truth->targetAt(id, stamp);
                target.point(sample ? sample->position : unknown);
            }
            json entry = target.take();
            entry["colour"] = colours.count(id) > 0 ? colours.at(id) : colour::grey;
            data["targets"].push_back(std::move(entry));
        }
        for (const auto& [id, place] : run_.truth->landmarks) {
            landmarks.point(place);
        }
        data["trueLandmarks"].update(landmarks.take());
    }

    const RunFolder& run_;
    std::vector<std::size_t> frames_;
    std::vector<Stamp> stamps_;
    MapView view_;
    double pixel_ = 1;
    int digits_ = 3;
    std::map<TrackId, std::size_t> track_index_;
    std::map<LandmarkId, std::size_t> landmark_index_;
};

}  // namespace

std::vector<LandmarkSight> visibleChanges(const std::vector<LandmarkSight>& sights, double pixel) {
    std::map<LandmarkId, std::size_t> last;
    for (std::size_t i = 0; i < sights.size(); ++i) {
        last[sights[i].id] = i;
    }
    std::map<LandmarkId, const LandmarkSight*> kept;
    std::vector<LandmarkSight> changes;
    for (std::size_t i = 0; i < sights.size(); ++i) {
        const LandmarkSight& sight = sights[i];
        const LandmarkSight*& before = kept[sight.id];
        const bool seen = !before || last[sight.id] == i || (sight.mean - before->mean).norm() > pixel ||
                          std::abs(3 * std::sqrt(sight.covariance.trace()) -
                                   3 * std::sqrt(before->covariance.trace())) > pixel;
        if (seen) {
            before = &sight;
            changes.push_back(sight);
        }
    }
    return changes;
}

std::string replayData(const RunFolder& run) {
    return Writer(run).text();
}

}  // namespace slamot::report

#include "sections/ReplayScene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "TrackStyles.h"
#include "TrueOrigin.h"
#include "sections/ReplayColumns.h"

namespace slamot::report {
namespace {

using nlohmann::json;

constexpr std::size_t most_frames = 2000, most_sights = 60000;
constexpr double map_pixels = 900;        // about the width of the picture
constexpr double sure_existence = 0.995;  // is drawn like 1

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

/// Frames without the track since it was last there.
void fillGap(ReplayColumns& columns, std::size_t wanted) {
    while (columns.take().contains("x") && columns.take()["x"].size() < wanted) {
        columns.unknown({"x", "y", "a", "b", "angle"});
        columns.whole("mode", 0);
    }
}

}  // namespace

ReplayScene::ReplayScene(const RunFolder& of_run) : run(of_run), frames_(framesOf(of_run)) {
    findView();
    digits_ = static_cast<int>(std::ceil(-std::log10(pixel_ / 20)));
    for (const std::size_t frame : frames_) {
        stamps_.push_back(run.run.trajectory[frame].stamp);
    }
    if (frames_.size() < run.run.trajectory.size()) {
        cuts_.push_back(fmt::format("{} of {} steps are frames.", frames_.size(), run.run.trajectory.size()));
    }
    makeLandmarks();
    makeTracks();
    makeSeen();
    makeTentative();
    makeParticles();
}

/// The map with room at its rim.
void ReplayScene::findView() {
    Points2 ways;
    std::vector<MapObject> objects;
    for (const eval::RobotRow& row : run.run.trajectory) {
        ways.push_back(row.robot.mean.position());
    }
    for (const eval::PosePair& pair : run.pairs) {
        ways.push_back(trueOrigin(pair.truth.position(), run.truth->point, pair.estimate.mean.theta));
    }
    for (const auto& [stamp, tracks] : run.run.tracks) {
        for (const TrackEstimate& track : tracks) {
            objects.push_back({track.mean.head<2>()});
        }
    }
    for (const LandmarkEstimate& landmark : run.run.landmarks) {
        objects.push_back(mapObject(landmark.mean, landmark.covariance));
    }
    view_ = mapView(ways, objects);
    const Vector2 rim = 0.04 * (view_.high - view_.low).maxCoeff() * Vector2::Ones();
    view_.low -= rim;
    view_.high += rim;
    pixel_ = (view_.high - view_.low).maxCoeff() / map_pixels;
}

std::size_t ReplayScene::frameOf(Stamp stamp) const {
    const auto at = std::lower_bound(stamps_.begin(), stamps_.end(), stamp);
    return std::min(static_cast<std::size_t>(at - stamps_.begin()), stamps_.size() - 1);
}

void ReplayScene::makeTracks() {
    tracks_ = json::array();
    std::map<TrackId, ReplayColumns> columns;
    std::map<TrackId, std::size_t> from;
    for (std::size_t f = 0; f < stamps_.size(); ++f) {
        const auto present = run.run.tracks.find(stamps_[f]);
        std::set<TrackId> here;
        if (present != run.run.tracks.end()) {
            for (const TrackEstimate& track : present->second) {
                from.try_emplace(track.id, f);
                ReplayColumns& of_track = columns.try_emplace(track.id, digits_).first->second;
                fillGap(of_track, f - from[track.id]);
                of_track.point(track.mean.head<2>());
                of_track.ellipse(track.covariance.topLeftCorner<2, 2>());
                const auto& p = track.mode_probabilities;
                of_track.whole("mode", std::max_element(p.begin(), p.end()) - p.begin());
            }
        }
    }
    for (const StyledTrack& track : styledTracks(run.run)) {
        const auto found = columns.find(track.id);
        if (found == columns.end()) {
            continue;  // it lived between two frames
        }
        json entry = found->second.take();
        entry["name"] = nameOf(track);
        entry["colour"] = track.style.colour;
        entry["from"] = from[track.id];
        track_index_[track.id] = tracks_.size();
        tracks_.push_back(std::move(entry));
    }
}

void ReplayScene::makeLandmarks() {
    double pixel = pixel_ / 2;
    std::vector<LandmarkSight> places = visibleChanges(run.sights, pixel);
    for (int tries = 0; places.size() > most_places && tries < 10; ++tries) {
        pixel *= 2;
        places = visibleChanges(run.sights, pixel);
    }
    if (places.empty()) {  // no history: the map of the end, from when each was first seen
        for (const LandmarkEstimate& l : run.run.landmarks) {
            places.push_back({l.first_seen, l.id, l.source, l.mean, l.covariance, l.existence});
        }
        std::sort(places.begin(), places.end(),
                  [](const LandmarkSight& a, const LandmarkSight& b) { return a.stamp < b.stamp; });
    }
    std::set<LandmarkId> kept;
    for (const LandmarkEstimate& l : run.run.landmarks) {
        kept.insert(l.id);
    }
    std::map<LandmarkId, std::size_t> last;
    for (std::size_t i = 0; i < places.size(); ++i) {
        last[places[i].id] = i;
    }
    const bool doubt = std::any_of(places.begin(), places.end(),
                                   [](const LandmarkSight& place) { return place.existence < sure_existence; });
    ReplayColumns columns(digits_);
    json result = {{"frame", json::array()}, {"index", json::array()}, {"x", json::array()},
                   {"y", json::array()},     {"a", json::array()},     {"b", json::array()},
                   {"angle", json::array()}};
    for (std::size_t i = 0; i < places.size(); ++i) {
        const LandmarkSight& place = places[i];
        const std::size_t index = landmark_index_.try_emplace(place.id, landmark_index_.size()).first->second;
        const auto frame = static_cast<std::int64_t>(frameOf(place.stamp));
        columns.whole("frame", frame);
        columns.whole("index", static_cast<std::int64_t>(index));
        columns.point(place.mean);
        columns.ellipse(place.covariance);
        if (doubt) {
            columns.whole("existence", std::llround(100 * place.existence));
        }
        if (run.map_known && last[place.id] == i && kept.count(place.id) == 0) {
            // Merged or removed since: nothing says when, so it goes after it was last seen.
            columns.whole("frame", frame + 1);
            columns.whole("index", static_cast<std::int64_t>(index));
            columns.unknown({"x", "y", "a", "b", "angle"});
            if (doubt) {
                columns.unknown({"existence"});
            }
        }
    }
    result.update(columns.take());
    result["count"] = landmark_index_.size();
    landmarks_ = std::move(result);
}

void ReplayScene::makeSeen() {
    std::map<Stamp, std::size_t> frame_at;
    for (std::size_t f = 0; f < stamps_.size(); ++f) {
        frame_at[stamps_[f]] = f;
    }
    std::vector<std::pair<std::size_t, std::int64_t>> all;  // frame and thing
    for (const eval::InnovationRow& row : run.run.innovations) {
        const auto frame = frame_at.find(row.stamp);
        if (frame == frame_at.end()) {
            continue;
        }
        const auto landmark = landmark_index_.find(row.innovation.landmark);
        const auto track = track_index_.find(row.innovation.track);
        if (track != track_index_.end()) {
            all.emplace_back(frame->second, -1 - static_cast<std::int64_t>(track->second));
        } else if (landmark != landmark_index_.end()) {
            all.emplace_back(frame->second, static_cast<std::int64_t>(landmark->second));
        }
    }
    seen_ = json::array();
    for (std::size_t f = 0; f < stamps_.size(); ++f) {
        seen_.push_back(json::array());
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (isKept(i, all.size(), most_sights)) {
            seen_[all[i].first].push_back(all[i].second);
        }
    }
    if (all.size() > most_sights) {
        cuts_.push_back(
            fmt::format("Of what is seen at a frame {} of {} lines are drawn.", most_sights, all.size()));
    }
}

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
                                   3 * std::sqrt(before->covariance.trace())) > pixel ||
                          std::abs(sight.existence - before->existence) > visible_existence;
        if (seen) {
            before = &sight;
            changes.push_back(sight);
        }
    }
    return changes;
}

}  // namespace slamot::report

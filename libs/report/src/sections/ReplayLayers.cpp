#include "sections/ReplayLayers.h"

#include <cmath>

#include "TrackStyles.h"
#include "TrueOrigin.h"
#include "sections/ReplayColumns.h"
#include "slamot/core/data/Angle.h"
#include "slamot/report/Palette.h"

namespace slamot::report {
namespace {

using nlohmann::json;

json robotTruth(const ReplayScene& scene) {
    ReplayColumns robot(scene.digits());
    const Truth& truth = *scene.run.truth;
    for (const std::size_t frame : scene.frames()) {
        const auto& [stamp, estimate] = scene.run.run.trajectory[frame];
        const auto pose = truth.pointAt(stamp);
        robot.point(pose ? trueOrigin(pose->position(), truth.point, estimate.mean.theta)
                         : Vector2::Constant(std::nan("")));
    }
    return robot.take();
}

json targetTruth(const ReplayScene& scene) {
    std::map<SourceId, std::string> colours;
    for (const StyledTrack& track : styledTracks(scene.run.run)) {
        colours.try_emplace(track.source, track.style.colour);
    }
    json targets = json::array();
    for (const auto& [id, samples] : scene.run.truth->targets) {
        ReplayColumns target(scene.digits());
        for (const Stamp stamp : scene.stamps()) {
            const auto sample = scene.run.truth->targetAt(id, stamp);
            target.point(sample ? sample->position : Vector2::Constant(std::nan("")));
        }
        json entry = target.take();
        entry["colour"] = colours.count(id) > 0 ? colours.at(id) : colour::grey;
        targets.push_back(std::move(entry));
    }
    return targets;
}

json truth(const ReplayScene& scene) {
    if (!scene.run.truth) {
        return nullptr;
    }
    ReplayColumns places(scene.digits());
    for (const auto& [id, place] : scene.run.truth->landmarks) {
        places.point(place);
    }
    json landmarks = {{"x", json::array()}, {"y", json::array()}};
    landmarks.update(places.take());
    return {{"robot", robotTruth(scene)}, {"targets", targetTruth(scene)}, {"landmarks", landmarks}};
}

json sight(const ReplayScene& scene) {
    json sensors = json::array();
    for (const auto& sensor : scene.run.list("sensors")) {
        // null where there is no limit; without one of range no field of view is drawn
        const auto number = [&](const char* name, double otherwise = 0) {
            const auto found = sensor.find(name);
            return found != sensor.end() && found->is_number() ? found->get<double>() : otherwise;
        };
        sensors.push_back({{"x", number("x")},
                           {"y", number("y")},
                           {"theta", number("theta")},
                           {"range", number("max_range")},
                           {"view", number("field_of_view", 2 * pi)}});
    }
    return {{"sensors", sensors}, {"seen", scene.seen()}};
}

json landmarks(const ReplayScene& scene) {
    return scene.landmarks();
}

json tentative(const ReplayScene& scene) {
    return scene.tentative();
}

json particles(const ReplayScene& scene) {
    return scene.particles();
}

json tracks(const ReplayScene& scene) {
    return scene.tracks();
}

json robot(const ReplayScene& scene) {
    ReplayColumns columns(scene.digits());
    for (const std::size_t frame : scene.frames()) {
        const PoseGaussian& pose = scene.run.run.trajectory[frame].robot;
        columns.point(pose.mean.position());
        columns.add("theta", pose.mean.theta, 3);
        columns.ellipse(pose.covariance.topLeftCorner<2, 2>());
    }
    return columns.take();
}

using Keys = std::vector<ReplayKey>;
using Symbol = ReplayKey::Symbol;

Keys truthKeys(const ReplayScene& scene) {
    Keys keys;
    if (!scene.run.truth->landmarks.empty()) {
        keys.push_back({Symbol::cross, "true landmark", colour::grey});
    }
    keys.push_back({Symbol::wide_line, "true way", colour::text});
    return keys;
}

Keys sightKeys(const ReplayScene& scene) {
    const bool any = !scene.run.sights.empty() || !scene.run.run.innovations.empty();
    return any ? Keys{{Symbol::line, "seen at this step", colour::sky}} : Keys();
}

Keys landmarkKeys(const ReplayScene& scene) {
    const bool any = !scene.run.run.landmarks.empty() || !scene.run.sights.empty();
    const bool doubt = scene.landmarks().contains("existence");
    const char* words = doubt ? "landmark, paler the less its existence is certain" : "landmark";
    return any ? Keys{{Symbol::square, words, colour::black}} : Keys();
}

Keys tentativeKeys(const ReplayScene&) {
    return {{Symbol::frame, "may be a landmark", colour::black}};
}

Keys particleKeys(const ReplayScene&) {
    return {{Symbol::dots, "particle, paler the less it weighs", colour::orange}};
}

Keys trackKeys(const ReplayScene& scene) {
    const std::vector<std::string>& modes = scene.run.run.mode_names;
    Keys keys;
    for (std::size_t m = 0; m < modes.size() && modes.size() > 1; ++m) {
        keys.push_back({Symbol::disc, "track in mode " + modes[m], seriesStyle(m).colour});
    }
    return keys;
}

Keys robotKeys(const ReplayScene&) {
    return {{Symbol::arrow, "robot and its way", colour::blue}};
}

}  // namespace

const std::vector<ReplayLayer>& replayLayers() {
    static const std::vector<ReplayLayer> layers = {{"truth", "truth", true, truth, truthKeys},
                                                    {"sight", "field of view and what is seen", true, sight, sightKeys},
                                                    {"landmarks", "", true, landmarks, landmarkKeys},
                                                    {"tentative", "what may be a landmark", true, tentative,
                                                     tentativeKeys},
                                                    {"tracks", "", true, tracks, trackKeys},
                                                    {"particles", "particles", true, particles, particleKeys},
                                                    {"robot", "", true, robot, robotKeys},
                                                    {"ellipses", "3σ ellipses", true, nullptr},
                                                    {"follow", "follow the robot", false, nullptr}};
    return layers;
}

}  // namespace slamot::report

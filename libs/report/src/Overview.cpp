#include "slamot/report/Overview.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "OverviewView.h"
#include "TrackStyles.h"
#include "TrueOrigin.h"
#include "sections/Courses.h"

namespace slamot::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double true_width = 5,
                 true_opacity = 0.35;  // wide and pale below the thin, full line of the estimate
constexpr std::size_t names_in_legend = 10;

/// A track's estimated way, with gaps where it was absent.
struct TrackWay {
    StyledTrack track;
    Points2 points;
};

/// The longest first.
std::vector<TrackWay> trackWays(const eval::RunRecord& run) {
    std::map<TrackId, Points2> ways;
    for (const eval::RobotRow& row : run.trajectory) {
        for (auto& [id, points] : ways) {
            points.emplace_back(nan, nan);
        }
        const auto present = run.tracks.find(row.stamp);
        if (present == run.tracks.end()) {
            continue;
        }
        for (const TrackEstimate& track : present->second) {
            Points2& points = ways[track.id];
            if (!points.empty()) {
                points.pop_back();
            }
            points.push_back(track.mean.head<2>());
        }
    }
    std::vector<TrackWay> sorted;
    for (const StyledTrack& track : styledTracks(run)) {
        sorted.push_back({track, std::move(ways[track.id])});
    }
    return sorted;
}

/// The part of a true way within the run's time, with gaps where truth is silent for longer than it usually
/// is.
template <class Sample, class Position>
Points2 trueWay(const std::vector<Sample>& samples, const eval::RunRecord& run, Position position) {
    std::vector<const Sample*> within;
    for (const Sample& sample : samples) {
        if (run.trajectory.empty() ||
            (run.trajectory.front().stamp <= sample.stamp && sample.stamp <= run.trajectory.back().stamp)) {
            within.push_back(&sample);
        }
    }
    std::vector<double> intervals;
    for (std::size_t i = 1; i < within.size(); ++i) {
        intervals.push_back(secondsBetween(within[i - 1]->stamp, within[i]->stamp));
    }
    const double longest = longestInterval(intervals);
    Points2 points;
    for (std::size_t i = 0; i < within.size(); ++i) {
        if (i > 0 && intervals[i - 1] > longest) {
            points.emplace_back(nan, nan);
        }
        points.push_back(position(*within[i]));
    }
    return points;
}

/// Everything drawn on the map, gathered once.
struct MapContent {
    Points2 robot, true_robot, landmarks, true_landmarks;
    std::vector<GaussianPoint> landmark_gaussians;
    std::vector<TrackWay> tracks;
    std::map<SourceId, Points2> true_targets;
};

MapContent contentOf(const eval::RunRecord& run, const Truth* truth) {
    MapContent content;
    for (const eval::RobotRow& row : run.trajectory) {
        content.robot.push_back(row.robot.mean.position());
    }
    for (const LandmarkEstimate& landmark : run.landmarks) {
        content.landmarks.push_back(landmark.mean);
        content.landmark_gaussians.push_back({landmark.mean, landmark.covariance});
    }
    content.tracks = trackWays(run);
    if (truth) {
        content.true_robot = trueWay(truth->robot, run, [&](const TruePose& p) {
            return trueOrigin(p.pose.position(), truth->point, estimatedHeading(run.trajectory, p.stamp));
        });
        for (const auto& [id, samples] : truth->targets) {
            content.true_targets[id] = trueWay(samples, run, [](const TrueTarget& t) { return t.position; });
        }
        for (const auto& [id, position] : truth->landmarks) {
            content.true_landmarks.push_back(position);
        }
    }
    return content;
}

MapView viewOf(const MapContent& content) {
    Points2 ways = content.robot;
    const auto append = [&ways](const Points2& way) { ways.insert(ways.end(), way.begin(), way.end()); };
    append(content.true_robot);
    for (const auto& [id, points] : content.true_targets) {
        append(points);
    }
    for (const TrackWay& track : content.tracks) {
        append(track.points);
    }
    std::vector<MapObject> objects;
    for (const GaussianPoint& landmark : content.landmark_gaussians) {
        objects.push_back(mapObject(landmark.mean, landmark.covariance));
    }
    return mapView(ways, objects);
}

Line trueLine(std::string label, Points2 points, std::string colour) {
    return {std::move(label), std::move(points), std::move(colour), true_width, Dash::solid, true_opacity};
}

void addLandmarks(Panel& map, const MapContent& content) {
    const std::size_t count = std::max(content.landmarks.size(), content.true_landmarks.size());
    const double size = count > 500 ? 2.6 : count > 100 ? 3 : count > 30 ? 4 : 5;
    if (!content.true_landmarks.empty()) {
        map.layers.push_back(
            Points{"Landmarks, true", content.true_landmarks, colour::pale_grey, Symbol::times, size + 2});
    }
    if (!content.landmarks.empty()) {
        map.layers.push_back(Ellipses{"Landmarks, 3σ ellipses", content.landmark_gaussians, 3, colour::text});
        map.layers.push_back(
            Points{"Landmarks, estimated", content.landmarks, colour::text, Symbol::dot, size});
    }
}

/// Tracks of one object share its colour and its entry in the legend; what is true of it is the same colour,
/// pale. An object without a track is grey.
void addTargets(Panel& map, const MapContent& content) {
    std::map<SourceId, std::size_t> tracks_of;
    std::map<SourceId, std::string> colours;
    for (const TrackWay& way : content.tracks) {
        ++tracks_of[way.track.source];
        colours[way.track.source] = way.track.style.colour;
    }
    std::set<SourceId> named;
    std::size_t names = 0;
    std::vector<Layer> estimates;
    for (const TrackWay& way : content.tracks) {
        const StyledTrack& track = way.track;
        std::string label;
        if (names < names_in_legend && (!track.source.valid() || named.insert(track.source).second)) {
            const std::size_t count = tracks_of[track.source];
            label = track.source.valid() && count > 1
                        ? fmt::format("Object {}, {} tracks", track.source.value, count)
                        : nameOf(track);
            ++names;
        }
        estimates.push_back(Line{label, way.points, track.style.colour, 1.6, track.style.dash});
    }
    if (!content.true_targets.empty()) {  // an entry of the legend without points of its own
        map.layers.push_back(trueLine("Moving objects, true", {}, colour::grey));
    }
    for (const auto& [id, points] : content.true_targets) {
        const auto object = colours.find(id);
        map.layers.push_back(trueLine("", points, object == colours.end() ? colour::grey : object->second));
    }
    map.layers.insert(map.layers.end(), estimates.begin(), estimates.end());
}

void addRobot(Panel& map, const MapContent& content) {
    if (!content.true_robot.empty()) {
        map.layers.push_back(trueLine("Robot, true", content.true_robot, colour::blue));
    }
    map.layers.push_back(Line{"Robot, estimated", content.robot, colour::blue, 1.6});
    if (!content.robot.empty()) {
        map.layers.push_back(
            Points{"Start", {content.robot.front()}, colour::blue, Symbol::square, 12, 1, true});
        map.layers.push_back(Points{"End", {content.robot.back()}, colour::blue, Symbol::dot, 8, 1, true});
    }
}

Panel mapPanel(const MapContent& content) {
    const MapView view = viewOf(content);
    const Eigen::Vector2d extent = view.high - view.low,
                          rim = 0.03 * extent.maxCoeff() * Eigen::Vector2d::Ones();
    Panel map;
    map.x.label = "x";
    map.y.label = "y";
    map.x.unit = map.y.unit = "m";
    map.x.min = view.low.x() - rim.x();
    map.x.max = view.high.x() + rim.x();
    map.y.min = view.low.y() - rim.y();
    map.y.max = view.high.y() + rim.y();
    map.equal_aspect = true;
    map.legend = LegendPlace::right;
    constexpr double usual_width = 600;  // of the plotting area beside the legend, pixels
    map.height = std::clamp(usual_width * extent.y() / extent.x(), 300.0, 620.0);
    addLandmarks(map, content);
    addTargets(map, content);
    addRobot(map, content);
    if (view.outside > 0) {
        map.note =
            fmt::format("{} of {} landmarks lie outside the view.", view.outside, content.landmarks.size());
    }
    return map;
}

struct ErrorCurve {
    Points2 errors;  ///< [s since the start, m]; NaN where truth is silent
    std::vector<BandRow> bound;
    double rmse = nan;
};

ErrorCurve errorCurve(const eval::RunRecord& run, const Truth& truth) {
    ErrorCurve curve;
    double squares = 0;
    std::size_t count = 0;
    bool covariance_known = false;
    for (const eval::RobotRow& row : run.trajectory) {
        const double t = secondsBetween(run.trajectory.front().stamp, row.stamp);
        const std::optional<Pose2> pose = truth.pointAt(row.stamp);
        const double error = pose ? (row.robot.mean * truth.point - pose->position()).norm() : nan;
        if (pose) {
            squares += error * error;
            ++count;
        }
        curve.errors.emplace_back(t, error);
        const Matrix2 covariance = row.robot.covariance.topLeftCorner<2, 2>();
        covariance_known = covariance_known || !covariance.isZero(0);
        const double largest = Eigen::SelfAdjointEigenSolver<Matrix2>(covariance).eigenvalues()[1];
        curve.bound.push_back({t, 0, 3 * std::sqrt(std::max(0.0, largest))});
    }
    curve.rmse = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : nan;
    if (!covariance_known) {
        curve.bound.clear();
    }
    return curve;
}

Panel errorPanel(const ErrorCurve& curve) {
    Panel panel;
    panel.x = timeAxis("Time since the start");
    panel.y.label = "Position error";
    panel.y.unit = "m";
    panel.y.min = 0;
    panel.height = 150;
    if (!curve.bound.empty()) {
        panel.layers.push_back(Band{"3σ bound along the widest axis", curve.bound});
    }
    panel.layers.push_back(Line{"Robot's distance from its true position", curve.errors, colour::blue, 1.2});
    return panel;
}

std::string summary(const eval::RunRecord& run, const MapContent& content, double rmse) {
    const double duration = run.trajectory.empty()
                                ? 0
                                : secondsBetween(run.trajectory.front().stamp, run.trajectory.back().stamp);
    const auto counted = [](std::size_t count, const char* what) {
        return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
    };
    std::string text =
        fmt::format("{:.1f} s, {}, {}, {}", duration, counted(run.trajectory.size(), "step"),
                    counted(content.landmarks.size(), "landmark"), counted(content.tracks.size(), "track"));
    if (std::isfinite(rmse)) {
        text += fmt::format("; robot position RMSE {:.3g} m", rmse);
    }
    return text;
}

}  // namespace

Figure overviewFigure(const eval::RunRecord& run, const Truth* truth, const OverviewText& text) {
    const MapContent content = contentOf(run, truth);
    Figure figure;
    figure.title = text.title;
    figure.panels.push_back(mapPanel(content));
    double rmse = nan;
    if (truth) {
        const ErrorCurve curve = errorCurve(run, *truth);
        rmse = curve.rmse;
        if (std::isfinite(rmse)) {
            figure.panels.push_back(errorPanel(curve));
        }
    }
    figure.subtitle = text.subtitle.empty() ? summary(run, content, rmse) : text.subtitle;
    return figure;
}

}  // namespace slamot::report

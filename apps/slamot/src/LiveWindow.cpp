#include "LiveWindow.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <mrpt/gui/CDisplayWindow3D.h>
#include <mrpt/gui/keycodes.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/system/CObserver.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <thread>

#include "Command.h"
#include "slamot/run/MrptShapes.h"

namespace slamot::app {
namespace {

using Clock = std::chrono::steady_clock;
using mrpt::img::TColor;

namespace colour = run::shape_colour;
using run::makeEllipse;
using run::placeEllipse;

/// Times real time; the last is as fast as can be.
constexpr std::array<double, 8> speeds{1, 2, 5, 10, 20, 50, 100, 0};
const mrpt::opengl::TFontParams dark_text = [] {
    mrpt::opengl::TFontParams font;
    font.color = {0.1f, 0.1f, 0.1f};
    return font;
}();

constexpr std::chrono::milliseconds frame_time{40}, key_time{10};

/// MRPT's window waits in vain where there is no display, so it is asked for first. The X library is loaded
/// by name: the program needs it for nothing else. The connection stays: a virtual X server starts anew when
/// its last client leaves, and would refuse the window meanwhile.
bool hasDisplay() {
    void* library = dlopen("libX11.so.6", RTLD_LAZY);
    const auto open =
        library ? reinterpret_cast<void* (*)(const char*)>(dlsym(library, "XOpenDisplay")) : nullptr;
    return open && open(nullptr);
}

mrpt::opengl::CSetOfLines::Ptr makeLines(const TColor& line_colour, float width) {
    auto lines = mrpt::opengl::CSetOfLines::Create();
    lines->setColor_u8(line_colour);
    lines->setLineWidth(width);
    return lines;
}

void extend(mrpt::opengl::CSetOfLines& way, const Vector2& p) {
    if (way.empty())
        way.appendLine(p.x(), p.y(), 0.0, p.x(), p.y(), 0.0);
    else
        way.appendLineStrip(p.x(), p.y(), 0.0);
}

/// MRPT's own thread would destroy the window that the run's thread draws in. So it only notes that the user
/// wants it closed, and the run's thread closes it.
class CloseRequest : public mrpt::system::CObserver {
  public:
    bool wanted() const { return wanted_; }
    /// From now on the window may close.
    void allow() { allowed_ = true; }

  protected:
    void OnEvent(const mrpt::system::mrptEvent& event) override {
        if (allowed_ || !event.isOfType<mrpt::gui::mrptEventWindowClosed>()) return;
        const auto* closed = event.getAs<mrpt::gui::mrptEventWindowClosed>();
        const_cast<mrpt::gui::mrptEventWindowClosed*>(closed)->allow_close = false;  // MRPT's way to answer
        wanted_ = true;
    }

  private:
    std::atomic<bool> wanted_{false}, allowed_{false};
};

/// Adds the time of its life.
class HeldBack {
  public:
    explicit HeldBack(double& seconds) : seconds_(seconds) {}
    ~HeldBack() { seconds_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
    HeldBack(const HeldBack&) = delete;
    HeldBack& operator=(const HeldBack&) = delete;

  private:
    double& seconds_;
    Clock::time_point begin_ = Clock::now();
};

}  // namespace

struct LiveWindow::Impl {
    struct Track {
        mrpt::opengl::CSetOfLines::Ptr way;
        mrpt::opengl::CSetOfLines::Ptr ellipse;
    };

    const std::atomic<bool>& stop;
    CloseRequest close_request;
    std::unique_ptr<mrpt::gui::CDisplayWindow3D> window;  ///< null once it was closed
    mrpt::opengl::CSetOfObjects::Ptr world = mrpt::opengl::CSetOfObjects::Create();
    mrpt::opengl::CSetOfTriangles::Ptr robot = run::makeRobotArrow();
    mrpt::opengl::CSetOfLines::Ptr robot_ellipse = makeEllipse(colour::robot);
    mrpt::opengl::CSetOfLines::Ptr robot_way = makeLines(colour::robot, 2.5f),
                                   sight = makeLines(colour::sight, 1.0f);
    std::map<TrackId, Track> tracks;
    std::map<LandmarkId, mrpt::opengl::CSetOfLines::Ptr> landmarks;
    std::map<LandmarkId, LandmarkEstimate> changed;  ///< since the last frame
    std::size_t speed = 3;
    bool paused = false, single_step = false, follow = true, was_placed = false;
    Stamp start, paced_from;  ///< of the run; where the present speed began
    Clock::time_point paced_at = Clock::now(), last_frame{};
    double held_back = 0;  ///< [s]
    double reach = 10;     ///< how far one sees around the robot [m]

    Impl(const std::string& title, const std::atomic<bool>& stop_flag)
        : stop(stop_flag), window(std::make_unique<mrpt::gui::CDisplayWindow3D>(title, 1000, 800)) {
        world->insert(robot_way);
        world->insert(sight);
        world->insert(robot_ellipse);
        world->insert(robot);
        auto& scene = window->get3DSceneAndLock();
        scene->insert(world);
        scene->getViewport()->setCustomBackgroundColor(colour::background);
        window->unlockAccess3DScene();
        close_request.observeBegin(*window);
        window->setCameraProjective(false);
        window->setCameraElevationDeg(90);
        window->setCameraAzimuthDeg(-90);
    }

    /// For the run's thread alone, which closes the window here where it was asked to.
    bool open() {
        if (window && close_request.wanted()) close();
        return window != nullptr;
    }

    void close() {
        close_request.allow();
        window.reset();
    }

    void pace(Stamp now) {
        paced_from = now;
        paced_at = Clock::now();
    }

    /// MRPT tells which key it was, so letters are capital and + is = on keyboards that have them on one key.
    /// Whether there was any.
    bool takeKeys(Stamp now) {
        bool any = false;
        while (open() && window->keyHit()) {
            const int key = window->getPushedKey();
            any = true;
            const bool faster = key == '+' || key == '=' || key == mrpt::gui::MRPTK_NUMPAD_ADD;
            const bool slower = key == '-' || key == mrpt::gui::MRPTK_NUMPAD_SUBTRACT;
            if (faster && speed + 1 < speeds.size()) ++speed;
            if (slower && speed > 0) --speed;
            if (key == ' ') paused = !paused;
            if (key == 'S') paused = single_step = true;
            if (key == 'F') follow = !follow;
            if (key == 'Q') close();
            if (faster || slower || key == ' ') pace(now);
        }
        return any;
    }

    /// Holds the run back to the chosen speed, and while it is paused.
    void waitFor(const Estimate& estimate) {
        const Stamp now = estimate.stamp;
        const HeldBack timing(held_back);
        while (open() && !stop) {
            if (takeKeys(now) && open()) show(estimate);
            if (single_step) {
                single_step = false;
                pace(now);
                return;
            }
            const double factor = speeds[speed];
            const auto due = paced_at + std::chrono::duration<double>(
                                            factor > 0 ? secondsBetween(paced_from, now) / factor : 0.0);
            if (!paused && Clock::now() >= due) return;
            std::this_thread::sleep_for(key_time);
        }
    }

    void drawSight(const run::Step& step) {
        sight->clear();
        const Pose2& pose = step.estimate.robot.mean;
        for (const RangeBearingSensor& sensor : step.detections.rangeBearing().sensors) {
            if (!(sensor.max_range > 0) || !std::isfinite(sensor.max_range)) continue;
            reach = std::max(reach, 1.2 * sensor.max_range);
            constexpr int pieces = 40;
            const Vector2 at = pose * sensor.pose.position();
            const auto rim = [&](int k) {
                const double angle = pose.theta + sensor.pose.theta +
                                     sensor.field_of_view * (static_cast<double>(k) / pieces - 0.5);
                return Vector2(at + sensor.max_range * Vector2(std::cos(angle), std::sin(angle)));
            };
            for (int k = 0; k < pieces; ++k) {
                const Vector2 a = rim(k), b = rim(k + 1);
                sight->appendLine(a.x(), a.y(), 0.0, b.x(), b.y(), 0.0);
            }
            if (sensor.field_of_view < 2 * pi - 1e-6)
                for (const Vector2& end : {rim(0), rim(pieces)})
                    sight->appendLine(at.x(), at.y(), 0.0, end.x(), end.y(), 0.0);
        }
        for (const LandmarkEstimate& l : step.touched)
            sight->appendLine(pose.x, pose.y, 0.0, l.mean.x(), l.mean.y(), 0.0);
    }

    void extendWays(const Estimate& estimate) {
        extend(*robot_way, estimate.robot.mean.position());
        for (const TrackEstimate& t : estimate.tracks) {
            const auto [found, is_new] = tracks.try_emplace(t.id);
            Track& track = found->second;
            if (is_new) {
                const TColor& of_track =
                    colour::tracks[static_cast<std::size_t>(t.id.value) % colour::tracks.size()];
                track = {makeLines(of_track, 2.0f), makeEllipse(of_track)};
                world->insert(track.way);
                world->insert(track.ellipse);
            }
            extend(*track.way, t.mean.head<2>());
        }
    }

    void drawRobot(const PoseGaussian& pose) {
        placeEllipse(*robot_ellipse, pose.mean.position(), pose.covariance.topLeftCorner<2, 2>());
        robot->setScale(static_cast<float>(std::max(0.5, reach / 15)));  // to be seen
        robot->setPose(mrpt::poses::CPose3D(pose.mean.x, pose.mean.y, 0, pose.mean.theta, 0, 0));
    }

    void drawTracks(const Estimate& estimate) {
        for (auto& [id, track] : tracks) track.ellipse->setVisibility(false);
        for (const TrackEstimate& t : estimate.tracks) {
            const Track& track = tracks.at(t.id);
            placeEllipse(*track.ellipse, t.mean.head<2>(), t.covariance.topLeftCorner<2, 2>());
            track.ellipse->setVisibility(true);
        }
    }

    void drawLandmarks() {
        for (const auto& [id, landmark] : changed) {
            auto& ellipse = landmarks[id];
            if (!ellipse) {
                ellipse = makeEllipse(colour::landmark);
                world->insert(ellipse);
            }
            placeEllipse(*ellipse, landmark.mean, landmark.covariance);
        }
        changed.clear();
    }

    void show(const Estimate& estimate) {
        const double factor = speeds[speed];
        const std::string pace_text = factor > 0 ? fmt::format("x{:.0f}", factor) : "fastest";
        window->addTextMessage(10, 26,
                               fmt::format("{:.1f} s  {}{}  {} landmarks, {} tracks",
                                           secondsBetween(start, estimate.stamp), pace_text,
                                           paused ? ", paused" : "", estimate.landmark_count, estimate.tracks.size()),
                               0, dark_text);
        window->addTextMessage(10, 8,
                               fmt::format("[space] pause  [s] step  [+ -] speed  [f] follow{}  [q] close",
                                           follow ? " on" : " off"),
                               1, dark_text);
        const Vector2 at = estimate.robot.mean.position();
        if (follow || !was_placed) {
            window->setCameraPointingToPoint(static_cast<float>(at.x()), static_cast<float>(at.y()), 0);
            window->setCameraZoom(static_cast<float>(2.5 * reach));
            was_placed = true;
        }
        window->repaint();
        last_frame = Clock::now();
    }
};

LiveWindow::LiveWindow(const std::string& title, const std::atomic<bool>& stop) {
    if (!hasDisplay())
        throw UsageError("--live: there is no display (DISPLAY), expected one to open a window on");
    impl_ = std::make_unique<Impl>(title, stop);
}

LiveWindow::~LiveWindow() {
    if (impl_->window) impl_->close();
}

double LiveWindow::heldBack() const {
    return impl_->held_back;
}

void LiveWindow::step(const run::Step& step) {
    Impl& live = *impl_;
    const Estimate& estimate = step.estimate;
    if (live.start == Stamp{}) {
        live.start = estimate.stamp;
        live.pace(estimate.stamp);
    }
    if (!live.open() || !step.has_detections) return;
    for (const LandmarkEstimate& l : step.touched) live.changed[l.id] = l;
    live.window->get3DSceneAndLock();
    live.extendWays(estimate);
    live.window->unlockAccess3DScene();
    // At the highest speeds not every step can be a frame.
    if (Clock::now() - live.last_frame >= frame_time || live.paused) {
        live.window->get3DSceneAndLock();
        live.drawRobot(estimate.robot);
        live.drawSight(step);
        live.drawTracks(estimate);
        live.drawLandmarks();
        live.window->unlockAccess3DScene();
        live.show(estimate);
    }
    live.waitFor(estimate);
}

void LiveWindow::end(const run::RunEnd& end) {
    Impl& live = *impl_;
    if (!live.open()) return;
    live.window->get3DSceneAndLock();
    live.extendWays(end.estimate);
    live.drawRobot(end.estimate.robot);
    live.drawTracks(end.estimate);
    // What was removed or merged on the way goes.
    for (auto& [id, ellipse] : live.landmarks) ellipse->setVisibility(false);
    for (const LandmarkEstimate& l : end.landmarks) live.changed[l.id] = l;
    for (const auto& [id, landmark] : live.changed)
        if (live.landmarks[id]) live.landmarks[id]->setVisibility(true);
    live.drawLandmarks();
    live.window->unlockAccess3DScene();
    live.show(end.estimate);
}

void LiveWindow::waitUntilClosed() {
    while (impl_->open() && !impl_->stop) {
        impl_->takeKeys({});
        std::this_thread::sleep_for(key_time);
    }
}

}  // namespace slamot::app

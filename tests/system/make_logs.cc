// Writes logs that no well-behaved program writes, for the system tests: `make_logs FOLDER`.
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <limits>
#include <vector>

#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/RawlogReader.h"
#include "slamot/rawlog/RawlogWriter.h"

namespace {

using namespace slamot;
using Observations = std::vector<mrpt::obs::CObservation::Ptr>;

constexpr int steps = 100;
constexpr double dt = 0.1, speed = 1;

Stamp at(double t) {
    return later(action_frame_epoch, t);
}

mrpt::obs::CObservation::Ptr odometry(double t, const std::string& label = "odometry") {
    return toMrpt(OdometryReading{at(t), {speed * t, 0, 0}, BodyVelocity{speed, 0, 0}}, label);
}

/// Landmarks on both sides of the way, as seen at time t; `edit` may spoil a reading.
using Edit = std::function<void(RangeBearingReading::Item&)>;
mrpt::obs::CObservationBearingRange::Ptr seen(double t, const std::string& label = "landmarks",
                                              double range_std = 0.1, const Edit& edit = {},
                                              int landmarks = 6) {
    RangeBearingReading reading;
    reading.stamp = at(t);
    reading.sensor.label = label;
    reading.sensor.max_range = 100;
    for (int id = 0; id < landmarks; ++id) {
        const double x = 3.0 * id - speed * t, y = id % 2 ? 5.0 + 0.1 * id : -4.0 - 0.1 * id;
        RangeBearingReading::Item item;
        item.range = std::hypot(x, y);
        item.bearing = std::atan2(y, x);
        item.id = SourceId{id};
        if (edit) edit(item);
        reading.items.push_back(item);
    }
    return toMrpt(reading, range_std, range_std / 10);
}

Observations drive(const std::function<mrpt::obs::CObservation::Ptr(double)>& sensor,
                   bool with_odometry = true) {
    Observations log;
    for (int k = 0; k < steps; ++k) {
        if (with_odometry) log.push_back(odometry(k * dt));
        if (auto o = sensor(k * dt)) log.push_back(o);
    }
    return log;
}

void write(const std::string& file, const Observations& log) {
    RawlogWriter writer(file);
    for (const auto& o : log) writer.write(*o);
    writer.close();
}

void writeFrames(const std::string& file, bool with_holes, bool with_nan = false) {
    RawlogWriter writer(file);
    for (int k = 0; k < steps; ++k) {
        mrpt::obs::CActionCollection actions;
        if (!with_holes || k % 7 != 3) {
            mrpt::obs::CActionRobotMovement2D action;
            mrpt::obs::CActionRobotMovement2D::TMotionModelOptions model;
            model.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
            action.computeFromOdometry(mrpt::poses::CPose2D(speed * dt, 0, 0), model);
            action.timestamp = toMrpt(at((k + 1) * dt));
            if (with_nan && k == 50) action.rawOdometryIncrementReading.x(std::nan(""));
            actions.insert(action);
        }
        mrpt::obs::CSensoryFrame frame;
        frame.insert(seen((k + 1) * dt, ""));
        writer.writeFrame(actions, frame);
    }
    writer.close();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "make_logs FOLDER\n";
        return 2;
    }
    const std::string folder = std::string(argv[1]) + "/";
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    const auto plain = [](double t) { return seen(t); };

    write(folder + "good.rawlog", drive(plain));
    write(folder + "no_odometry.rawlog", drive(plain, false));
    write(folder + "no_detections.rawlog", drive([](double) { return nullptr; }));
    write(folder + "unknown_labels.rawlog", drive([](double t) { return seen(t, "front camera"); }));
    write(folder + "no_noise.rawlog", drive([](double t) { return seen(t, "landmarks", 0); }));
    write(folder + "odd_label.rawlog",
          drive([](double t) { return seen(t, t < 1 ? "a,b\n\"\xff" : "landmarks"); }));
    write(folder + "some_unusable.rawlog", drive([&](double t) {
              return seen(t, "landmarks", 0.1, [&](auto& item) {
                  if (item.id.value == 1) item.range = nan;
                  if (item.id.value == 2) item.bearing = inf;
                  if (item.id.value == 3) item.range = -1;
              });
          }));
    write(folder + "all_nan.rawlog",
          drive([&](double t) { return seen(t, "landmarks", 0.1, [&](auto& item) { item.range = nan; }); }));

    write(folder + "no_identities.rawlog", drive([](double t) {
              return seen(t, "landmarks", 0.1, [](auto& item) { item.id = SourceId{}; });
          }));

    Observations back = drive(plain);
    std::swap(back[20], back[24]);   // 0.2 s late: put in order
    back.push_back(odometry(1.05));  // 8.85 s late: dropped
    write(folder + "time_back.rawlog", back);

    Observations invalid = drive(plain);
    for (std::size_t i = 1; i < invalid.size(); i += 10) invalid[i]->timestamp = mrpt::Clock::time_point();
    write(folder + "some_without_stamp.rawlog", invalid);
    for (auto& o : invalid) o->timestamp = mrpt::Clock::time_point();
    write(folder + "no_stamps.rawlog", invalid);

    Observations two = drive(plain);
    for (int k = 0; k < steps; ++k) two.push_back(odometry(k * dt, "visual"));
    std::stable_sort(two.begin(), two.end(),
                     [](const auto& a, const auto& b) { return a->timestamp < b->timestamp; });
    write(folder + "two_odometries.rawlog", two);

    // Many landmarks in sight all the time: slow enough to be interrupted on any machine.
    Observations slow;
    for (int k = 0; k < 500; ++k) {
        slow.push_back(odometry(k * dt));
        slow.push_back(seen(k * dt, "landmarks", 0.1, {}, 200));
    }
    write(folder + "slow.rawlog", slow);

    writeFrames(folder + "frames.rawlog", false);
    writeFrames(folder + "frames_with_holes.rawlog", true);
    writeFrames(folder + "frames_with_nan.rawlog", false, true);
    return 0;
}

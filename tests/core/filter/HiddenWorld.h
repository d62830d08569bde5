#pragma once
// A small world whose sensor tells no identities: landmarks, movers and clutter around a robot that drives in
// circles. The log also knows who was who, for the run it is measured against.
#include <cmath>
#include <cstdint>
#include <vector>

#include "slamot/core/filter/JointFilter.h"
#include "slamot/core/random/Clutter.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Scenes.h"

namespace slamot::test {

struct HiddenWorldOptions {
    std::uint64_t seed = 1;
    int landmarks = 25, movers = 2;
    double radius = 8, range = 10;  ///< [m] of the robot's circle and of its sensor
    int steps = 240;                ///< of 0.25 s and 0.25 m
    double detection_probability = 0.9;
    double landmark_clutter = 4, mover_clutter = 1;  ///< per scan
    bool kinds_known = true;
};

/// The robot drives 0.25 m a step on a circle about the origin, by odometry with deviations of 0.02 m,
/// 0.01 m and 0.01 rad a step, and looks all around, with deviations of 0.1 m and 0.02 rad. Landmarks
/// stand at least 2 m apart, up to 5 m inside and outside the circle. Movers go along inside, about 4 m away.
class HiddenWorld {
  public:
    struct Step {
        OdometryIncrement odometry;
        DetectionSet hidden;    ///< identities taken away
        DetectionSet labelled;  ///< with them; clutter has none
        Pose2 robot;
        std::vector<Vector2> movers;
    };

    explicit HiddenWorld(const HiddenWorldOptions& options = {})
        : options_(options), random_(options.seed, RandomPurpose::test) {
        while (static_cast<int>(landmarks.size()) < options.landmarks) {
            const double inner = options.radius - 5, outer = options.radius + 5;
            const double radius = std::sqrt(random_.uniform(inner * inner, outer * outer)),
                         angle = random_.uniform(-pi, pi);
            const Vector2 at = radius * Vector2(std::cos(angle), std::sin(angle));
            bool free = true;
            for (const Vector2& other : landmarks) free = free && (other - at).norm() >= 2;
            if (free) landmarks.push_back(at);
        }
        move_ = {0.25, 0, 0.25 / options.radius};
        Pose2 robot = start().mean;
        for (int k = 1; k <= options.steps; ++k) {
            robot = robot * move_;
            steps.push_back(step(k, robot));
        }
    }

    PoseGaussian start() const { return {{options_.radius, 0, 0.5 * pi}, Matrix3::Zero()}; }
    /// What a filter is to know of this world.
    static JointFilterParameters parameters() {
        JointFilterParameters p;
        p.life.landmarks.clutter_per_scan = 4;
        p.life.movers.clutter_per_scan = 1;
        p.life.movers.new_per_scan = 0.1;
        p.target_velocity_std = 1;
        p.target_acceleration_std = 0.5;
        p.target.noise_std = 0.3;
        return p;
    }
    static RobotMotionParameters motion() {
        RobotMotionParameters motion;
        motion.model = RobotMotionModel::increment;
        return motion;
    }

    std::vector<Vector2> landmarks;
    std::vector<Step> steps;

  private:
    static constexpr double dt = 0.25;

    Vector2 moverAt(int mover, int k) const {
        const double ahead = (mover % 2 == 0 ? 4 : -4) * (1 + mover / 2);  // [m] along the circle
        const double angle = (0.25 * k + ahead) / options_.radius;
        return (options_.radius - (mover % 2 == 0 ? 3.0 : 3.5)) * Vector2(std::cos(angle), std::sin(angle));
    }

    Step step(int k, const Pose2& robot) {
        Step out;
        out.robot = robot;
        const Vector3 deviation(0.02, 0.01, 0.01);
        out.odometry =
            odometry(dt * (k - 1), dt * k,
                     {move_.x + deviation.x() * random_.normal(), move_.y + deviation.y() * random_.normal(),
                      move_.theta + deviation.z() * random_.normal()});
        out.odometry.covariance = deviation.array().square().matrix().asDiagonal();

        std::vector<RangeBearingDetection> all;
        const auto look = [&](const Vector2& at, ObjectKind kind, int id) {
            RangeBearingDetection d = seen(robot, at, kind, id);
            const bool detected = random_.uniform() < options_.detection_probability;
            d.range += 0.1 * random_.normal();
            d.bearing = wrapAngle(d.bearing + 0.02 * random_.normal());
            if (detected && d.range <= options_.range) all.push_back(d);
        };
        for (std::size_t i = 0; i < landmarks.size(); ++i)
            look(landmarks[i], ObjectKind::landmark, static_cast<int>(i));
        for (int m = 0; m < options_.movers; ++m) {
            out.movers.push_back(moverAt(m, k));
            look(out.movers.back(), ObjectKind::mover, m);
        }
        RangeBearingSensor sensor;
        sensor.max_range = options_.range;
        for (const ObjectKind kind : {ObjectKind::landmark, ObjectKind::mover})
            for (const Vector2& z : drawClutter(
                     sensor, kind == ObjectKind::mover ? options_.mover_clutter : options_.landmark_clutter,
                     random_)) {
                RangeBearingDetection d;
                d.range = z.x();
                d.bearing = z.y();
                d.covariance = Vector2(0.01, 0.0004).asDiagonal();
                d.kind = kind;
                all.push_back(d);
            }
        // The order of a scan tells nothing.
        for (std::size_t i = all.size(); i > 1; --i)
            std::swap(all[i - 1], all[static_cast<std::size_t>(random_.uniform(0, static_cast<double>(i)))]);

        out.labelled = detectionsAt(dt * k, all);
        for (RangeBearingDetection& d : all) {
            d.source = {};
            if (!options_.kinds_known) d.kind = ObjectKind::unknown;
        }
        out.hidden = detectionsAt(dt * k, all);
        for (DetectionSet* set : {&out.hidden, &out.labelled})
            std::get<RangeBearingSet>(set->measurements).sensors[0] = sensor;
        return out;
    }

    HiddenWorldOptions options_;
    RandomStream random_;
    Pose2 move_;
};

}  // namespace slamot::test

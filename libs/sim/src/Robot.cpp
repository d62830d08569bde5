#include "slamot/sim/Robot.h"

#include <cmath>
#include <limits>

#include "slamot/core/random/RandomStream.h"
#include "slamot/sim/Controller.h"

namespace slamot::sim {
namespace {

/// u = [ds dl dtheta] of a robot that goes along an arc for dt at [v omega].
Vector3 arcControl(const Vector2& u, double dt) {
    return {u.x() * dt * sinc(0.5 * u.y() * dt), 0, u.y() * dt};
}

/// Noise of an arc's [ds dl dtheta]: random walks along path and turn, as RobotMotionParameters has them.
Vector3 arcNoise(const RobotMotionParameters& motion, const Vector3& u, RandomStream& random) {
    const double root_path = std::sqrt(std::abs(u.x())), turn = std::abs(u.z());
    const double heading_std =
        std::sqrt(motion.heading_std_per_sqrt_m * motion.heading_std_per_sqrt_m * std::abs(u.x()) +
                  motion.heading_std_per_sqrt_rad * motion.heading_std_per_sqrt_rad * turn);
    const double along = random.normal(0, motion.along_std_per_sqrt_m * root_path);
    const double across = random.normal(0, motion.across_std_per_sqrt_m * root_path);
    return {along, across, random.normal(0, heading_std)};
}

/// Noise of [v gamma] or [v omega], one draw for as long as a command holds.
Vector2 controlNoise(const RobotMotionParameters& motion, RandomStream& random) {
    const double speed = random.normal(0, motion.speed_std);
    return {speed, random.normal(0, motion.model == RobotMotionModel::steered ? motion.steering_std
                                                                              : motion.turn_rate_std)};
}

/// Where u = [v gamma] or [v omega], with `arc_noise` on the arc model's control, leads in dt.
Pose2 moved(const RobotMotionParameters& motion, const Pose2& pose, const Vector2& u,
            const Vector3& arc_noise, double dt) {
    const Vector3 x = pose.vector();
    switch (motion.model) {
        case RobotMotionModel::steered:
            return Pose2::fromVector(steeredMotion<double>(x, u, dt, motion.wheelbase));
        case RobotMotionModel::differential:
            return Pose2::fromVector(differentialMotion<double>(x, u, dt));
        default:
            return Pose2::fromVector(arcMotion<double>(x, arcControl(u, dt) + arc_noise));
    }
}

BodyVelocity bodyVelocity(const RobotMotionParameters& motion, const Vector2& u) {
    if (motion.model == RobotMotionModel::steered) return steeredToBody(u.x(), u.y(), motion.wheelbase);
    return {u.x(), 0, u.y()};
}

}  // namespace

RobotRun simulateRobot(const Scenario& scenario, const RobotParameters& robot, const World& world,
                       const std::vector<Trajectory>& movers, std::uint64_t seed) {
    const Trajectory* target = nullptr;
    for (const Trajectory& mover : movers) {
        if (mover.id == robot.target) target = &mover;
    }
    const auto targetAt = [&](int step) -> std::optional<Vector2> {
        const TrueTarget* state = target ? target->at(step) : nullptr;
        return state ? std::optional(state->position) : std::nullopt;
    };

    Controller controller(robot, world);
    Pose2 pose{robot.start.x(), robot.start.y(), wrapAngle(robot.start_heading)}, dead_reckoned;
    RobotRun run;
    run.poses.push_back(pose);
    run.odometry.push_back({scenario.stampOfStep(0), dead_reckoned, BodyVelocity{}});

    Vector2 command = Vector2::Zero(), noise = Vector2::Zero();
    for (int step = 1; step <= scenario.steps; ++step) {
        const double dt = scenario.secondsOfStep(step);
        RandomStream random(seed, RandomPurpose::control, static_cast<std::uint32_t>(robot.number),
                            static_cast<std::uint32_t>(step));
        const bool is_arc = robot.motion.model == RobotMotionModel::arc;
        if ((step - 1) % robot.control_every_n_steps == 0) {
            command = controller.command(pose, targetAt(step - 1));
            if (!is_arc) noise = controlNoise(robot.motion, random);
        }
        const Vector3 arc_noise =
            is_arc ? arcNoise(robot.motion, arcControl(command, dt), random) : Vector3(Vector3::Zero());
        pose = moved(robot.motion, pose, command + noise, arc_noise, dt);
        dead_reckoned = moved(robot.motion, dead_reckoned, command, Vector3::Zero(), dt);
        run.poses.push_back(pose);
        if (step % robot.control_every_n_steps == 0 || step == scenario.steps) {
            run.odometry.push_back(
                {scenario.stampOfStep(step), dead_reckoned, bodyVelocity(robot.motion, command)});
        }
    }
    return run;
}

Trajectory asMover(const Scenario& scenario, const RobotParameters& robot, const RobotRun& run) {
    Trajectory trajectory{SourceId{robot_id_base + robot.number}, 0, {}};
    const Vector2 unknown = Vector2::Constant(std::numeric_limits<double>::quiet_NaN());
    Vector2 velocity = Vector2::Zero();
    for (int step = 0; step <= scenario.steps; ++step) {
        const Vector2 position = run.poses[step].position();
        if (step > 0) velocity = (position - run.poses[step - 1].position()) / scenario.secondsOfStep(step);
        trajectory.states.push_back({scenario.stampOfStep(step), position, velocity, unknown, ""});
    }
    return trajectory;
}

}  // namespace slamot::sim

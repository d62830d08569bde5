#pragma once
// A simulated experiment as parameters: world, movers, robots, sensors. Read from an INI file or filled in by
// a program. doc/simulator.md is its reference. SI units and radians.
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/config/Config.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Identities.h"
#include "slamot/core/data/Pose2.h"
#include "slamot/core/data/Stamp.h"
#include "slamot/core/models/RobotMotion.h"
#include "slamot/core/models/TargetMotion.h"

namespace slamot::sim {

/// Every simulated log starts here, 2010-01-01 00:00:00 UTC.
inline constexpr Stamp epoch{1262304000LL * Stamp::ticks_per_second};

/// A mover's id of this plus k is robot k.
inline constexpr std::int64_t robot_id_base = 1000000;

/// An axis-parallel rectangle [m]; the border belongs to it.
struct Box {
    double x_min = -50, x_max = 50, y_min = -50, y_max = 50;
    bool contains(const Vector2& p) const {
        return p.x() >= x_min && p.x() <= x_max && p.y() >= y_min && p.y() <= y_max;
    }
};

enum class WorldKind { uniform, loop, file };
enum class LoopShape { circle, square };

/// Section `[world]`: where the landmarks stand.
struct WorldParameters {
    WorldKind kind = WorldKind::uniform;
    int landmarks = 100;
    Box box;                              ///< uniform
    double min_distance = 0;              ///< [m] uniform: between any two landmarks
    LoopShape shape = LoopShape::circle;  ///< loop
    double length = 200;                  ///< [m] loop: of the centre line
    double side_offset = 5;               ///< [m] loop: of the landmarks from the centre line, either side
    double side_jitter = 1;               ///< [m] loop: uniform, plus or minus, along and across
    std::string file;                     ///< file: CSV with id,x,y; relative to the scenario's folder
    int file_every = 1;                   ///< file: one of so many rows is there, the first of all
};

enum class MoverModel { cv, ca, ct, unicycle, schedule, waypoint };

/// From `time` [s after the start] on, a scheduled mover moves by `kind`.
struct ScheduleEntry {
    double time = 0;
    TargetModelKind kind = TargetModelKind::cv;
    std::optional<double> turn_rate;  ///< [rad/s] ct and unicycle: instead of the mover's own
};

/// Section `[mover.<id>]`.
struct MoverParameters {
    SourceId id{0};
    MoverModel model = MoverModel::cv;
    std::vector<ScheduleEntry> schedule;
    // Driving noise, standard deviations; one draw holds for a step (piecewise constant).
    double cv_acceleration_std = 0.1;            ///< [m/s^2]
    double ca_jerk_std = 0.1;                    ///< [m/s^3]
    double ct_acceleration_std = 0.1;            ///< [m/s^2]
    double ct_turn_rate = radians(10);           ///< [rad/s]
    double unicycle_acceleration_std = 0.1;      ///< [m/s^2] along the heading
    double unicycle_turn_rate = 0;               ///< [rad/s] at the start of the model
    double unicycle_turn_rate_std = radians(1);  ///< [rad/s] change per step
    double unicycle_speed_jitter = 0;            ///< [m/s] independent from step to step (paper 2)
    double unicycle_turn_rate_jitter = 0;        ///< [rad/s] independent from step to step (paper 2)
    // Waypoint movers.
    std::vector<Vector2> path;
    std::string path_file;               ///< CSV with x,y that loadScenario read `path` from; or empty
    int loops = 0;                       ///< 0: for ever
    double speed = 1;                    ///< [m/s]
    double max_turn_rate = radians(60);  ///< [rad/s]
    double reach_distance = 1;           ///< [m]
    // Start: given, or drawn where it is not.
    std::optional<Vector2> position;  ///< [m]
    Box start_box{-20, 20, -20, 20};
    std::optional<Vector2> velocity;          ///< [m/s]
    double min_speed = 0.5, max_speed = 1.5;  ///< [m/s] drawn, with a uniform direction
    Vector2 acceleration = Vector2::Zero();   ///< [m/s^2] ca: at the start
    double appear = 0;                        ///< [s after the start]
    double vanish = std::numeric_limits<double>::infinity();
    /// A trajectory that leaves it is drawn again.
    std::optional<Box> arena;
    int max_redraws = 1000;
};

enum class ControllerKind { constant, waypoints, pursuit };

/// Pursuit drives at `speed` while the target is nearer than `distance`; the first level that fits holds.
struct SpeedLevel {
    double distance = 0, speed = 0;
};

/// Section `[robot]`, or `[robot.<number>]` where there are several. `motion` holds the true control noise.
struct RobotParameters {
    int number = 0;
    Vector2 start = Vector2::Zero();  ///< [m]
    double start_heading = 0;         ///< [rad]
    RobotMotionParameters motion;
    ControllerKind controller = ControllerKind::constant;
    double speed = 1;                   ///< [m/s] constant, waypoints
    double steering = 0;                ///< [rad] constant; steered robots
    double turn_rate = 0;               ///< [rad/s] constant; differential and arc robots
    double max_steering = radians(30);  ///< [rad] waypoints, pursuit
    std::vector<Vector2> path;          ///< waypoints; empty: the loop world's centre line
    std::string path_file;              ///< CSV with x,y that loadScenario read `path` from; or empty
    int loops = 1;                      ///< waypoints; 0: for ever
    double reach_distance = 2;          ///< [m] waypoints
    SourceId target{0};                 ///< pursuit
    std::vector<SpeedLevel> levels{
        {3, 0.5}, {10, 3}, {20, 6}, {40, 10}, {std::numeric_limits<double>::infinity(), 15}};
    int control_every_n_steps = 1;

    RobotParameters() { motion.model = RobotMotionModel::steered; }
};

enum class SensorRole { landmarks, movers, mixed };
enum class IdentityRule { automatic, written, hidden };

/// Section `[sensor.<label>]`.
struct SensorParameters {
    std::string label = "mixed";
    SensorRole role = SensorRole::mixed;
    std::vector<int> robots;               ///< numbers of the robots that carry it; empty: all
    Vector2 position = Vector2::Zero();    ///< [m] on the robot
    double orientation = 0;                ///< [rad] on the robot
    double field_of_view = pi;             ///< [rad] full width
    double min_range = 0, max_range = 30;  ///< [m]
    double range_std = 0.1;                ///< [m] claimed
    double bearing_std = radians(1);       ///< [rad] claimed
    std::optional<double> true_range_std, true_bearing_std;  ///< where they differ from the claim
    double detection_probability = 1;
    double clutter_per_scan = 0;
    double outlier_probability = 0;
    IdentityRule identities = IdentityRule::automatic;
    int every_n_steps = 1, phase = 0;

    bool writesIdentities() const {
        return identities == IdentityRule::written ||
               (identities == IdentityRule::automatic && role != SensorRole::mixed);
    }
};

struct Scenario {
    std::string about;
    double dt = 0.1;  ///< [s] a step
    int steps = 600;  ///< the log has steps 0..steps
    bool robots_see_each_other = true;
    WorldParameters world;
    std::vector<MoverParameters> movers;
    std::vector<RobotParameters> robots;
    std::vector<SensorParameters> sensors;

    Stamp stampOfStep(int step) const { return later(epoch, step * dt); }
    /// Length of the step that ends at `step`, to the tick as readers of the log see it.
    double secondsOfStep(int step) const { return secondsBetween(stampOfStep(step - 1), stampOfStep(step)); }
};

/// The general part, section `[scenario]`. The other sections have a table per element.
ParameterTable describe(Scenario& scenario);
ParameterTable describe(WorldParameters& world);
ParameterTable describe(MoverParameters& mover);
ParameterTable describe(RobotParameters& robot);
ParameterTable describe(SensorParameters& sensor);

/// Reads and checks a scenario, the paths of its path files included. Throws ConfigError; LogError for a bad
/// path file.
Scenario loadScenario(const Config& config);

/// Files that a loaded scenario is made from besides its own: landmarks and paths.
std::vector<std::string> filesOf(const Scenario& scenario);

/// Throws ConfigError, one sentence, for a scenario that cannot be simulated.
void requirePossible(const Scenario& scenario);

/// All sections with their keys and defaults as Markdown: the reference part of doc/simulator.md.
std::string scenarioReference();

}  // namespace slamot::sim

// One table per section of a scenario: keys, units, defaults, ranges.
#include "ScenarioText.h"
#include "slamot/core/random/Clutter.h"
#include "slamot/sim/Scenario.h"

namespace slamot::sim {
namespace {

// Nothing is infinite but the time a mover vanishes.
constexpr double max_count = 1e6;
constexpr double huge = 1e6;
constexpr Interval any_finite{-huge, huge};
constexpr Interval from_zero{0, huge};
constexpr Interval above_zero{0, huge, true, false};

constexpr const char* path_file_help =
    "a CSV with columns x,y to read the path from instead, relative to the scenario's folder.";

}  // namespace

ParameterTable describe(Scenario& s) {
    ParameterTable t("scenario", "The experiment as a whole.");
    t.text("about", s.about, "one line for people; goes into truth.json.");
    t.real("dt", s.dt, "s", {1e-4, 10}, "length of a step.");
    t.integer("steps", s.steps, {1, max_count}, "number of steps; the log has instants 0..steps.");
    t.flag("robots_see_each_other", s.robots_see_each_other,
           "with several robots: each is a mover with id 1000000 + number to the others.");
    return t;
}

ParameterTable describe(WorldParameters& w) {
    ParameterTable t("world", "Landmarks, numbered from 0.");
    t.choice("kind", w.kind,
             {{"uniform", WorldKind::uniform}, {"loop", WorldKind::loop}, {"file", WorldKind::file}},
             "uniform in a box; loop: on both sides of a closed corridor; file: a CSV with columns id,x,y.");
    t.integer("landmarks", w.landmarks, {0, max_count}, "uniform, loop: how many.");
    addBox(t, "box", w.box, "uniform: where.");
    t.real("min_distance", w.min_distance, "m", from_zero, "uniform: between any two landmarks.");
    t.choice("loop_shape", w.shape, {{"circle", LoopShape::circle}, {"square", LoopShape::square}},
             "loop: shape of the centre line, which passes the origin along +x, counter-clockwise.");
    t.real("loop_length", w.length, "m", {10, huge}, "loop: length of the centre line.");
    t.real("side_offset", w.side_offset, "m", from_zero,
           "loop: distance of the landmarks from the centre line.");
    t.real("side_jitter", w.side_jitter, "m", from_zero,
           "loop: landmarks are moved by up to this, uniformly, along and across.");
    t.text("file", w.file, "file: path, relative to the scenario's folder.");
    t.integer(
        "file_every", w.file_every, {1, max_count},
        "file: one of so many landmarks is there, by their order in the file, the first to begin with.");
    return t;
}

ParameterTable describe(MoverParameters& m) {
    ParameterTable t("mover." + std::to_string(m.id.value),
                     "A moving thing; the section's number is its id.");
    t.choice("model", m.model,
             {{"cv", MoverModel::cv},
              {"ca", MoverModel::ca},
              {"ct", MoverModel::ct},
              {"unicycle", MoverModel::unicycle},
              {"schedule", MoverModel::schedule},
              {"waypoint", MoverModel::waypoint}},
             "constant velocity, constant acceleration, coordinated turn, speed and turn rate, these by "
             "schedule, or "
             "along a path.");
    addSchedule(
        t, "schedule", m.schedule,
        "schedule: which model from when on; a third part is the turn rate [deg/s] of ct and unicycle.");
    t.real("cv_acceleration_std", m.cv_acceleration_std, "m/s^2", from_zero, "cv: driving noise.");
    t.real("ca_jerk_std", m.ca_jerk_std, "m/s^3", from_zero, "ca: driving noise.");
    t.real("ct_acceleration_std", m.ct_acceleration_std, "m/s^2", from_zero, "ct: driving noise.");
    t.real("ct_turn_rate_deg", m.ct_turn_rate, "deg/s", any_finite, "ct: turn rate, to the left.");
    t.real("unicycle_acceleration_std", m.unicycle_acceleration_std, "m/s^2", from_zero,
           "unicycle: driving noise along the heading.");
    t.real("unicycle_turn_rate_deg", m.unicycle_turn_rate, "deg/s", any_finite,
           "unicycle: turn rate at first.");
    t.real("unicycle_turn_rate_std_deg", m.unicycle_turn_rate_std, "deg/s", from_zero,
           "unicycle: change of the turn rate per step.");
    t.real("unicycle_speed_jitter", m.unicycle_speed_jitter, "m/s", from_zero,
           "unicycle: noise on the speed, independent from step to step (paper 2).");
    t.real("unicycle_turn_rate_jitter_deg", m.unicycle_turn_rate_jitter, "deg/s", from_zero,
           "unicycle: noise on the turn rate, independent from step to step (paper 2).");
    addPath(t, "path", m.path, "waypoint: the points to visit.");
    t.text("path_file", m.path_file, path_file_help);
    t.integer("loops", m.loops, {0, max_count}, "waypoint: how often the path is driven; 0 for ever.");
    t.real("speed", m.speed, "m/s", from_zero, "waypoint: pace.");
    t.real("max_turn_rate_deg", m.max_turn_rate, "deg/s", above_zero, "waypoint: fastest turn.");
    t.real("reach_distance", m.reach_distance, "m", above_zero, "waypoint: a point this near is reached.");
    addPoint(t, "position", m.position, "m", "at the start; auto: uniform in start_box.");
    addBox(t, "start_box", m.start_box, "where the position is drawn.");
    addPoint(t, "velocity", m.velocity, "m/s",
             "at the start; auto: drawn, for waypoint movers towards the first point.");
    t.real("min_speed", m.min_speed, "m/s", from_zero, "drawn velocity, of uniform direction.");
    t.real("max_speed", m.max_speed, "m/s", from_zero, "drawn velocity.");
    addPoint(t, "acceleration", m.acceleration, "m/s^2", "ca: at the start.");
    t.real("appear", m.appear, "s", from_zero, "after the start of the log.");
    t.real("vanish", m.vanish, "s", Interval::positiveOrInfinite(), "after the start of the log; gone from then on.");
    addBox(t, "arena", m.arena, "a trajectory that leaves it is drawn again as a whole.");
    t.integer("max_redraws", m.max_redraws, {0, max_count}, "after so many the scenario is an error.");
    return t;
}

ParameterTable describe(RobotParameters& r) {
    ParameterTable t("robot", "A robot; [robot.<number>] where there are several. Noise is the true one.");
    RobotMotionParameters& m = r.motion;
    addPoint(t, "start", r.start, "m", "position at the start.");
    t.real("start_heading_deg", r.start_heading, "deg", any_finite, "heading at the start.");
    t.choice("motion", m.model,
             {{"steered", RobotMotionModel::steered},
              {"differential", RobotMotionModel::differential},
              {"arc", RobotMotionModel::arc}},
             "how it moves; models of slamot/core/models/RobotMotion.h.");
    t.real("wheelbase", m.wheelbase, "m", above_zero,
           "steered; others turn, with the controllers waypoints and pursuit, as if they had it.");
    t.real("speed_std", m.speed_std, "m/s", from_zero, "steered, differential: one draw per command.");
    t.real("steering_std_deg", m.steering_std, "deg", from_zero, "steered: one draw per command.");
    t.real("turn_rate_std_deg", m.turn_rate_std, "deg/s", from_zero, "differential: one draw per command.");
    t.real("along_std_per_sqrt_m", m.along_std_per_sqrt_m, "m/sqrt(m)", from_zero,
           "arc: random walk along the path.");
    t.real("across_std_per_sqrt_m", m.across_std_per_sqrt_m, "m/sqrt(m)", from_zero,
           "arc: random walk across it.");
    t.real("heading_std_per_sqrt_m", m.heading_std_per_sqrt_m, "rad/sqrt(m)", from_zero,
           "arc: random walk of the heading by distance.");
    t.real("heading_std_per_sqrt_rad", m.heading_std_per_sqrt_rad, "rad/sqrt(rad)", from_zero,
           "arc: random walk of the heading by turn.");
    t.choice("controller", r.controller,
             {{"constant", ControllerKind::constant},
              {"waypoints", ControllerKind::waypoints},
              {"pursuit", ControllerKind::pursuit}},
             "who drives, seeing the true scene.");
    t.real("speed", r.speed, "m/s", any_finite, "constant, waypoints: commanded.");
    t.real("steering_deg", r.steering, "deg", {-90, 90, true, true},
           "constant: commanded to a steered robot.");
    t.real("turn_rate_deg", r.turn_rate, "deg/s", any_finite, "constant: commanded to the other robots.");
    t.real("max_steering_deg", r.max_steering, "deg", {0, 90, true, true},
           "waypoints, pursuit: limit either side.");
    addPath(t, "path", r.path, "waypoints: the points to visit; none: the centre line of a loop world.");
    t.text("path_file", r.path_file, path_file_help);
    t.integer("loops", r.loops, {0, max_count}, "waypoints: how often the path is driven; 0 for ever.");
    t.real("reach_distance", r.reach_distance, "m", above_zero, "waypoints: a point this near is reached.");
    addId(t, "target", r.target, "pursuit: id of the mover; while it is not there the robot stands.");
    addLevels(t, "levels", r.levels,
              "pursuit: speed while nearer than the distance; beyond the last: its speed.");
    t.integer("control_every_n_steps", r.control_every_n_steps, {1, max_count},
              "a command holds so long; odometry is logged at its end.");
    return t;
}

ParameterTable describe(SensorParameters& s) {
    ParameterTable t("sensor." + s.label,
                     "A range-bearing sensor; the section's second name is its label in the log.");
    t.choice(
        "role", s.role,
        {{"landmarks", SensorRole::landmarks}, {"movers", SensorRole::movers}, {"mixed", SensorRole::mixed}},
        "what it sees; labels of these names have this role by default.");
    addNumbers(t, "robots", s.robots, "numbers of the robots that carry it.");
    addPoint(t, "position", s.position, "m", "where it is mounted on the robot.");
    t.real("orientation_deg", s.orientation, "deg", any_finite, "where it looks, from the robot's heading.");
    t.real("field_of_view_deg", s.field_of_view, "deg", {0, 360, true, false}, "full width, rim included.");
    t.real("min_range", s.min_range, "m", from_zero, "nearest, included.");
    t.real("max_range", s.max_range, "m", above_zero, "farthest, included.");
    t.real("range_std", s.range_std, "m", above_zero, "noise the log claims.");
    t.real("bearing_std_deg", s.bearing_std, "deg", above_zero, "noise the log claims.");
    t.optionalReal("true_range_std", s.true_range_std, "m", from_zero, "noise it has; auto: as claimed.");
    t.optionalReal("true_bearing_std_deg", s.true_bearing_std, "deg", from_zero,
                   "noise it has; auto: as claimed.");
    t.real("detection_probability", s.detection_probability, "-", Interval::probability(),
           "of each object in view, each scan.");
    t.real("clutter_per_scan", s.clutter_per_scan, "-", {0, max_clutter_per_scan},
           "mean number of false detections (Poisson), uniform in range and bearing.");
    t.real("outlier_probability", s.outlier_probability, "-", Interval::probability(),
           "of a detection whose range and bearing are replaced by a uniform draw; its identity stays.");
    t.choice("identities", s.identities,
             {{"auto", IdentityRule::automatic},
              {"written", IdentityRule::written},
              {"hidden", IdentityRule::hidden}},
             "whether the log gives true ids; auto: written unless the role is mixed, where they would be "
             "ambiguous.");
    t.integer("every_n_steps", s.every_n_steps, {1, max_count}, "a scan every so many steps.");
    t.integer("phase", s.phase, {0, max_count}, "the step of the first scan, below every_n_steps.");
    return t;
}

std::string scenarioReference() {
    Scenario scenario;
    WorldParameters world;
    MoverParameters mover;
    RobotParameters robot;
    SensorParameters sensor;
    std::string text;
    const ParameterTable tables[] = {describe(scenario), describe(world), describe(robot), describe(mover),
                                     describe(sensor)};
    for (const ParameterTable& table : tables) text += toMarkdown(table) + "\n";
    return text;
}

}  // namespace slamot::sim

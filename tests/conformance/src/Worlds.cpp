#include "conformance/Worlds.h"

namespace slamot::conformance {
namespace {

sim::SensorParameters allRound(sim::SensorRole role, const std::string& label) {
    sim::SensorParameters sensor;
    sensor.role = role;
    sensor.label = label;
    sensor.field_of_view = 2 * pi;
    sensor.max_range = 20;
    sensor.range_std = 0.1;
    sensor.bearing_std = radians(1);
    return sensor;
}

sim::MoverParameters mover(int id) {
    sim::MoverParameters mover;
    mover.id = SourceId{id};
    mover.start_box = {-10, 10, -10, 10};
    return mover;
}

}  // namespace

sim::Scenario roundTrip() {
    sim::Scenario scenario;
    scenario.dt = 0.1;
    scenario.steps = 200;
    scenario.world.landmarks = 30;
    scenario.world.box = {-20, 20, -12, 28};

    sim::RobotParameters robot;  // goes round (0, 8) at 2 m/s: a radius of 1 m / sin(7.18 deg) = 8 m
    robot.motion.wheelbase = 1;
    robot.motion.speed_std = 0.1;
    robot.motion.steering_std = radians(1);
    robot.speed = 2;
    robot.steering = radians(7.18);
    scenario.robots = {robot};
    scenario.movers = {mover(0), mover(1)};
    scenario.sensors = {allRound(sim::SensorRole::landmarks, "landmarks"),
                        allRound(sim::SensorRole::movers, "movers")};
    return scenario;
}

sim::Scenario noiseFree() {
    sim::Scenario scenario = roundTrip();
    scenario.robots[0].motion.speed_std = scenario.robots[0].motion.steering_std = 0;
    for (sim::MoverParameters& mover : scenario.movers) mover.cv_acceleration_std = 0;
    for (sim::SensorParameters& sensor : scenario.sensors)
        sensor.true_range_std = sensor.true_bearing_std = 0;
    return scenario;
}

sim::Scenario roughBearings() {
    sim::Scenario scenario = roundTrip();
    for (sim::SensorParameters& sensor : scenario.sensors) sensor.bearing_std = radians(6);
    return scenario;
}

sim::Scenario behind() {
    sim::Scenario scenario = roundTrip();
    scenario.steps = 100;
    scenario.world.landmarks = 10;
    scenario.world.box = {3, 12, -0.3, 0.3};
    scenario.movers.clear();
    sim::RobotParameters& robot = scenario.robots[0];
    robot.start_heading = pi;
    robot.steering = 0;
    robot.speed = 0.5;
    return scenario;
}

sim::Scenario crowd() {
    sim::Scenario scenario = roundTrip();
    scenario.steps = 80;
    scenario.movers.clear();
    for (int id = 0; id < 50; ++id) {
        sim::MoverParameters one = mover(id);
        one.appear = 0.1 * (id % 40);
        one.vanish = one.appear + 0.5 + 0.1 * (id % 17);
        scenario.movers.push_back(one);
    }
    return scenario;
}

Play withNuisances(Play play) {
    for (std::size_t i = 0; i < play.steps.size(); ++i) {
        if (!play.steps[i].detections) continue;
        auto& set = std::get<RangeBearingSet>(play.steps[i].detections->measurements);
        if (set.detections.empty()) continue;
        RangeBearingDetection one = set.detections[i % set.detections.size()];
        set.detections.push_back(one);
        one.kind = ObjectKind::unknown;
        set.detections.push_back(one);
        one.kind = ObjectKind::landmark;
        one.source = {};
        set.detections.push_back(one);
        if (i % 20 == 5) {
            one.source = SourceId{std::int64_t{1} << 62};
            one.range = 1e-6;
            set.detections.push_back(one);
        }
        if (i % 20 == 10) {
            one = set.detections.front();
            one.range += 15;
            one.bearing = wrapAngle(one.bearing + 2);
            set.detections.push_back(one);
        }
    }
    return play;
}

}  // namespace slamot::conformance

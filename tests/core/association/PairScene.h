#pragma once
// A robot among landmarks, and a batch of detections, in a world that can be turned: what the sensor reports
// and how uncertain everything is relative to the robot stay the same.
#include <memory>
#include <vector>

#include "slamot/core/association/GatedPairs.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "support/Scenes.h"

namespace slamot::test {

struct PairScene {
    Pose2 robot;
    std::unique_ptr<DenseJointBank> bank;
    std::vector<BlockId> landmarks;
    std::vector<Vector2> positions;
    RangeBearingSet seen;
    std::vector<int> all;  ///< detections

    const JointView& state() const { return bank->mode(0); }
    GatedPairs gated(PairGates& gates) const {
        return gatedPairs(state(), landmarks, seen, all, bank->consistency(), gates);
    }
};

/// Landmarks at `around` in the robot's frame, all first seen from here; detections as given; robot_std [m,
/// m, rad].
inline PairScene pairScene(double heading, const std::vector<Vector2>& around, const std::vector<Vector2>& z,
                           const Vector3& robot_std, double landmark_std, Consistency consistency) {
    PairScene scene;
    scene.robot = Pose2{0, 0, heading} * Pose2{20, -7, 0};
    Matrix3 turn = Matrix3::Identity();
    turn.topLeftCorner<2, 2>() = rotation(heading);
    const Matrix3 P = turn * Matrix3(robot_std.array().square().matrix().asDiagonal()) * turn.transpose();
    scene.bank = std::make_unique<DenseJointBank>(scene.robot.vector(), P, consistency);
    for (const Vector2& p : around) {
        const Vector2 at = scene.robot * p;
        Eigen::Matrix<double, 2, 3> G;
        G << Matrix2::Identity(), quarterTurn() * (at - scene.robot.position());
        const Matrix2 own = landmark_std * landmark_std * Matrix2::Identity();
        scene.landmarks.push_back(scene.bank->augment(BlockKind::landmark, NewBlock{at, G, own}));
        scene.positions.push_back(at);
    }
    // Since then the robot has moved by an unknown bit: all landmarks lie off by the same.
    scene.bank->mode(0).propagate(robot_block, scene.robot.vector(), Matrix3::Identity(), P);
    scene.seen.sensors.emplace_back();
    scene.seen.sensors[0].max_range = 30;
    for (const Vector2& each : z) {
        RangeBearingDetection detection;
        detection.range = each.x();
        detection.bearing = wrapAngle(each.y());
        detection.covariance = Vector2(0.01, 0.0004).asDiagonal();
        scene.all.push_back(static_cast<int>(scene.seen.detections.size()));
        scene.seen.detections.push_back(detection);
    }
    return scene;
}

}  // namespace slamot::test

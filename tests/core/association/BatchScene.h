#pragma once
// A robot among landmarks and movers, and one batch of detections from two sensors, in a world that can be
// turned.
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "slamot/core/association/BatchAssociation.h"
#include "slamot/core/estimation/DenseJointBank.h"
#include "support/Scenes.h"

namespace slamot::test {

class BatchScene {
  public:
    /// robot_std [m, m, rad].
    explicit BatchScene(const Vector3& robot_std = Vector3::Zero(), double world_turn = 0,
                        Consistency consistency = Consistency::classic)
        : robot_(Pose2{0, 0, world_turn} * Pose2{20, -7, 0.3}) {
        Matrix3 turn = Matrix3::Identity();
        turn.topLeftCorner<2, 2>() = rotation(world_turn);
        const Matrix3 P = turn * Matrix3(robot_std.array().square().matrix().asDiagonal()) * turn.transpose();
        bank_ = std::make_unique<DenseJointBank>(robot_.vector(), P, consistency);
        for (const char* label : {"first", "second"}) {
            seen.sensors.emplace_back();
            seen.sensors.back().label = label;
        }
    }

    /// Objects at a place in the robot's frame, uncertain by `deviation` [m] on their own. Give their
    /// numbers.
    int landmark(const Vector2& at, double deviation = 0.1) {
        return add(ObjectKind::landmark, robot_ * at, deviation * deviation * Matrix2::Identity());
    }
    int mover(const Vector2& at, double deviation = 0.1) {
        Vector6 x = Vector6::Zero();
        x.head<2>() = robot_ * at;
        Matrix6 P = Matrix6::Identity();
        P.topLeftCorner<2, 2>() *= deviation * deviation;
        return add(ObjectKind::mover, x, P);
    }
    /// A detection with deviations 0.1 m and 0.02 rad of what is at that place in the robot's frame, off by
    /// `off`; gives its number.
    int detection(ObjectKind kind, const Vector2& at, const Vector2& off = {0, 0}, int sensor = 0) {
        RangeBearingDetection out = test::seen({}, at, kind, -1, seen.sensors[sensor].pose, sensor);
        out.range += off.x();
        out.bearing = wrapAngle(out.bearing + off.y());
        seen.detections.push_back(out);
        return static_cast<int>(seen.detections.size()) - 1;
    }

    BatchAssociation associate(const AssociationParameters& parameters) const {
        std::vector<int> all(seen.detections.size());
        std::iota(all.begin(), all.end(), 0);
        return associate(parameters, all);
    }
    BatchAssociation associate(const AssociationParameters& parameters,
                               const std::vector<int>& detections) const {
        return BatchAssociator(parameters, bank_->consistency())
            .associate(state(), objects, seen, detections,
                       std::vector<double>(seen.detections.size(), clutter));
    }

    const JointView& state() const { return bank_->mode(0); }

    RangeBearingSet seen;
    std::vector<VisibleObject> objects;
    double clutter = 0.05;  ///< 1/(m rad)

  private:
    template <class Mean, class Covariance>
    int add(ObjectKind kind, const Mean& mean, const Covariance& own) {
        const auto block = kind == ObjectKind::mover ? BlockKind::target : BlockKind::landmark;
        const BlockId id = bank_->augment(block, NewBlock{mean, BlockMatrix::Zero(mean.size(), 3), own});
        objects.push_back({id, kind, 0.9});
        return static_cast<int>(objects.size()) - 1;
    }

    Pose2 robot_;
    std::unique_ptr<DenseJointBank> bank_;
};

inline std::vector<int> objectsOf(const BatchAssociation& batch) {
    std::vector<int> out;
    for (const auto& pair : batch.of_detection) out.push_back(pair.object);
    return out;
}

/// Every method for landmarks with every method for movers, `known` left out.
inline std::vector<AssociationParameters> allMethods() {
    std::vector<AssociationParameters> out;
    for (const auto landmarks : {LandmarkAssociation::nearest, LandmarkAssociation::sequential,
                                 LandmarkAssociation::jcbb, LandmarkAssociation::gnn})
        for (const auto movers : {MoverAssociation::nearest, MoverAssociation::gnn, MoverAssociation::jpda}) {
            out.emplace_back();
            out.back().landmarks = landmarks;
            out.back().movers = movers;
        }
    return out;
}
inline std::string nameOf(const AssociationParameters& p) {
    return "landmarks " + std::to_string(static_cast<int>(p.landmarks)) + ", movers " +
           std::to_string(static_cast<int>(p.movers));
}

}  // namespace slamot::test

#include "slamot/core/estimation/ModalState.h"

#include <cmath>

#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

void KnownObjects::clear() {
    landmarks.clear();
    targets.clear();
    blocks.clear();
}

std::vector<NewBlock> ModalState::newLandmark(const RangeBearingDetection& detection,
                                              const Pose2& sensor) const {
    std::vector<NewBlock> by_mode;
    for (int j = 0; j < bank().modeCount(); ++j) {
        const FirstSight sight = firstSight(bank().mode(j), detection, sensor, bank().consistency());
        by_mode.push_back({sight.position, sight.G, sight.own});
    }
    return by_mode;
}

std::vector<NewBlock> ModalState::newTarget(const RangeBearingDetection& detection,
                                            const Pose2& sensor) const {
    std::vector<NewBlock> by_mode;
    for (const NewBlock& point : newLandmark(detection, sensor)) {
        // A mover's velocity and acceleration are not seen at first sight: priors around zero.
        Vector6 mean = Vector6::Zero();
        mean.head<2>() = point.mean;
        Eigen::Matrix<double, 6, 3> G = Eigen::Matrix<double, 6, 3>::Zero();
        G.topRows<2>() = point.G;
        Matrix6 own = Matrix6::Zero();
        own.topLeftCorner<2, 2>() = point.own;
        own.diagonal().segment<2>(2).setConstant(std::pow(settings().target_velocity_std, 2));
        own.diagonal().segment<2>(4).setConstant(std::pow(settings().target_acceleration_std, 2));
        by_mode.push_back({mean, G, own});
    }
    return by_mode;
}

}  // namespace slamot

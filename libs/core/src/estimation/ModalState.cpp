#include "slamot/core/estimation/ModalState.h"

#include <algorithm>

#include "slamot/core/estimation/RangeBearingUpdate.h"

namespace slamot {

void KnownObjects::clear() {
    landmarks.clear();
    targets.clear();
}

void ModalState::attend(const RangeBearingSet& seen, const std::vector<BlockId>& measured) {
    bank_->attend({Pose2::fromVector(mean(robot_block)), seen, measured}, mu_);
}

BlockId ModalState::addLandmark(const RelativeGaussian& landmark) {
    return bank_->augment(BlockKind::landmark, byMode(landmark));
}

BlockId ModalState::addLandmark(const std::vector<PastSight>& sights, double gate) {
    const PastSight& first = sights.front();
    const RelativeGaussian seen = firstSight(first.detection, first.sensor, bank_->consistency());
    std::vector<NewBlock> blocks;
    for (int j = 0; j < bank_->modeCount(); ++j) {
        blocks.push_back(inWorld(seen, bank_->mode(j).mean(first.from)));
        blocks.back().from = first.from;
    }
    const BlockId landmark = bank_->augment(BlockKind::landmark, blocks);
    for (auto sight = sights.begin() + 1; sight != sights.end(); ++sight) {
        std::vector<Linearisation> by_mode;
        for (int j = 0; j < bank_->modeCount(); ++j)
            by_mode.push_back(linearise(bank_->mode(j), landmark, sight->detection, sight->sensor,
                                        bank_->consistency(), sight->from));
        // As with outliers: a detection is odd when it is so in every mode.
        if (std::none_of(by_mode.begin(), by_mode.end(), [gate](const auto& m) { return m.nis <= gate; }))
            continue;
        for (int j = 0; j < bank_->modeCount(); ++j)
            bank_->mode(j).update({by_mode[static_cast<std::size_t>(j)].measurement});
    }
    return landmark;
}

BlockId ModalState::rememberPose(std::optional<BlockId> again) {
    const double reference = bank_->mode(0).mean(robot_block)(2);
    const auto pose = [&](int j) {
        Vector3 robot = bank_->mode(j).mean(robot_block);
        robot.z() = reference + angleDifference(robot.z(), reference);
        return robot;
    };
    if (!again) {
        std::vector<NewBlock> blocks;
        for (int j = 0; j < bank_->modeCount(); ++j)
            blocks.push_back({pose(j), Matrix3::Identity(), Matrix3::Zero()});
        return bank_->augment(BlockKind::pose, blocks);
    }
    for (int j = 0; j < bank_->modeCount(); ++j)
        bank_->mode(j).propagate(*again, pose(j), Matrix3::Zero(), Matrix3::Zero(),
                                 {{robot_block, Matrix3::Identity()}});
    return *again;
}

void ModalState::mergeLandmarks(BlockId kept, BlockId gone, double deviation) {
    for (int j = 0; j < bank_->modeCount(); ++j) {
        JointMode& mode = bank_->mode(j);
        LinearMeasurement same;
        same.add(kept, Matrix2::Identity());
        same.add(gone, -Matrix2::Identity());
        same.residual = mode.mean(gone) - mode.mean(kept);
        same.R = deviation * deviation * Matrix2::Identity();
        mode.update({same});
    }
    bank_->remove(gone);
}

std::vector<NewBlock> ModalState::byMode(const RelativeGaussian& object) const {
    std::vector<NewBlock> blocks;
    for (int j = 0; j < bank().modeCount(); ++j)
        blocks.push_back(inWorld(object, bank().mode(j).mean(robot_block)));
    return blocks;
}

}  // namespace slamot

#include "slamot/core/estimation/ModalState.h"

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

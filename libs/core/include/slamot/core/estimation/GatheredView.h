#pragma once
// Some blocks of a joint distribution, read once: for those that ask for many small covariances.
#include <unordered_map>

#include "slamot/core/estimation/JointBank.h"

namespace slamot {

/// Robot and `blocks`, which differ from one another. What is asked of others is an error: std::out_of_range.
class GatheredView : public JointView {
  public:
    GatheredView(const JointView& state, const std::vector<BlockId>& blocks);

    BlockVector mean(BlockId block) const override { return places_.at(block).mean; }
    BlockMatrix covariance(BlockId a, BlockId b) const override;
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;

  private:
    struct Place {
        Eigen::Index offset;
        BlockVector mean;
    };
    std::unordered_map<BlockId, Place> places_;
    Eigen::MatrixXd P_;
};

}  // namespace slamot

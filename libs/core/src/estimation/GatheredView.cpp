#include "slamot/core/estimation/GatheredView.h"

namespace slamot {

GatheredView::GatheredView(const JointView& state, const std::vector<BlockId>& blocks) {
    std::vector<BlockId> all{robot_block};
    all.insert(all.end(), blocks.begin(), blocks.end());
    Eigen::Index offset = 0;
    for (const BlockId block : all) {
        const BlockVector mean = state.mean(block);
        places_[block] = {offset, mean};
        offset += mean.size();
    }
    P_ = state.jointCovariance(all);
}

BlockMatrix GatheredView::covariance(BlockId a, BlockId b) const {
    const Place &row = places_.at(a), &column = places_.at(b);
    return P_.block(row.offset, column.offset, row.mean.size(), column.mean.size());
}

Eigen::MatrixXd GatheredView::jointCovariance(const std::vector<BlockId>& blocks) const {
    std::vector<Eigen::Index> rows;
    for (const BlockId block : blocks) {
        const Place& place = places_.at(block);
        for (Eigen::Index k = 0; k < place.mean.size(); ++k) rows.push_back(place.offset + k);
    }
    return P_(rows, rows);
}

}  // namespace slamot

#include <gtest/gtest.h>

#include <stdexcept>

#include "slamot/core/estimation/BlockLayout.h"

namespace slamot {
namespace block_layout_test {

TEST(BlockLayoutTest, OffsetsFollowTheOrderOfAddition) {
    BlockLayout layout;
    layout.append(0, BlockKind::robot, 3);
    layout.append(7, BlockKind::target, 6);
    layout.append(2, BlockKind::landmark, 2);  // ids in any order: a landmark that came back
    layout.append(9, BlockKind::extra, 4, 2);
    EXPECT_EQ(layout.dimension(), 15);
    EXPECT_EQ(layout.at(7).offset, 3);
    EXPECT_EQ(layout.at(2).offset, 9);
    EXPECT_EQ(layout.at(9).offset, 11);
    EXPECT_EQ(layout.at(0).turning, 1);
    EXPECT_EQ(layout.at(7).turning, 3);
    EXPECT_EQ(layout.at(2).turning, 1);
    EXPECT_EQ(layout.at(9).turning, 2);
}

TEST(BlockLayoutTest, RemovedBlocksLeaveNothingBehind) {
    BlockLayout layout;
    layout.append(0, BlockKind::robot, 3);
    for (BlockId id = 1; id <= 1000; ++id) {
        layout.append(id, BlockKind::target, 6);
        if (id > 2) layout.remove(id - 2);
    }
    EXPECT_EQ(layout.places().size(), 3u);
    EXPECT_EQ(layout.dimension(), 15);
    EXPECT_EQ(layout.at(999).offset, 3);
    EXPECT_EQ(layout.at(1000).offset, 9);
    EXPECT_FALSE(layout.contains(998));
    EXPECT_THROW(layout.at(998), std::out_of_range);
    EXPECT_THROW(layout.remove(998), std::out_of_range);
    EXPECT_THROW(layout.at(-1), std::out_of_range);
    layout.setPutAway(1000, true);
    EXPECT_TRUE(layout.at(1000).put_away);
    EXPECT_FALSE(layout.at(999).put_away);
}

}  // namespace block_layout_test
}  // namespace slamot

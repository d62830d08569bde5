#include <gtest/gtest.h>

#include <cstdio>

#include "slamot/rawlog/LogError.h"
#include "slamot/sim/World.h"
#include "support/TemporaryFolder.h"

namespace slamot::sim {
namespace world_test {

TEST(UniformWorld, FillsItsBoxEvenly) {
    WorldParameters p;
    p.landmarks = 4000;
    p.box = {-10, 30, 5, 7};
    const World world = makeWorld(p, 1);
    ASSERT_EQ(world.landmarks.size(), 4000u);
    EXPECT_EQ(world.landmarks.begin()->first, SourceId{0});
    EXPECT_EQ(world.landmarks.rbegin()->first, SourceId{3999});
    int left = 0, low = 0;
    for (const auto& [id, l] : world.landmarks) {
        ASSERT_TRUE(p.box.contains(l));
        left += l.x() < 10;
        low += l.y() < 6;
    }
    // Binomial(4000, 1/2): 2000 +- 31.6; 4 standard deviations, false alarm 6e-5 each.
    EXPECT_NEAR(left, 2000, 127);
    EXPECT_NEAR(low, 2000, 127);
}

TEST(UniformWorld, KeepsTheMinimumDistance) {
    WorldParameters p;
    p.landmarks = 100;
    p.min_distance = 5;
    const World world = makeWorld(p, 2);
    for (auto a = world.landmarks.begin(); a != world.landmarks.end(); ++a) {
        for (auto b = std::next(a); b != world.landmarks.end(); ++b) {
            ASSERT_GE((a->second - b->second).norm(), 5);
        }
    }
}

TEST(UniformWorld, SaysWhenThereIsNoRoom) {
    WorldParameters p;
    p.landmarks = 100;
    p.min_distance = 60;  // a box of 100 m x 100 m holds a handful of these
    EXPECT_THROW(makeWorld(p, 1), ConfigError);
}

TEST(UniformWorld, MoreLandmarksLeaveTheFirstOnesWhereTheyWere) {
    WorldParameters p;
    p.landmarks = 10;
    const World few = makeWorld(p, 3);
    p.landmarks = 20;
    const World many = makeWorld(p, 3);
    for (const auto& [id, l] : few.landmarks) EXPECT_EQ(many.landmarks.at(id), l);
    EXPECT_NE(makeWorld(p, 4).landmarks.at(SourceId{0}), few.landmarks.at(SourceId{0}));
}

TEST(LoopWorld, CircleHasLandmarksOnBothSidesOfItsCentreLine) {
    WorldParameters p;
    p.kind = WorldKind::loop;
    p.landmarks = 40;
    p.length = 200;
    p.side_offset = 5;
    p.side_jitter = 0;
    const World world = makeWorld(p, 1);
    const double radius = 200 / (2 * pi);  // centre (0, radius): the line starts at the origin along +x
    for (const auto& [id, l] : world.landmarks) {
        const double expected = id.value % 2 == 0 ? radius - 5 : radius + 5;  // left is inside
        EXPECT_NEAR((l - Vector2(0, radius)).norm(), expected, 1e-9);
    }
    for (const Vector2& p_line : world.centre_line)
        EXPECT_NEAR((p_line - Vector2(0, radius)).norm(), radius, 1e-9);
    EXPECT_NEAR(world.centre_line.back().norm(), 0, 1e-9);
    EXPECT_GT(world.centre_line.front().x(), 0);
}

TEST(LoopWorld, SquareHasItsFirstSideOnTheXAxis) {
    WorldParameters p;
    p.kind = WorldKind::loop;
    p.shape = LoopShape::square;
    p.landmarks = 8;  // four pairs, at 25, 75, 125, 175 m of 200
    p.length = 200;
    p.side_offset = 5;
    p.side_jitter = 0;
    const World world = makeWorld(p, 1);
    // 25 m from the origin is the corner (25, 0), where the second side, upwards, begins: left of it is -x.
    EXPECT_NEAR((world.landmarks.at(SourceId{0}) - Vector2(20, 0)).norm(), 0, 1e-9);
    EXPECT_NEAR((world.landmarks.at(SourceId{1}) - Vector2(30, 0)).norm(), 0, 1e-9);
    double length = 0;
    Vector2 previous(0, 0);
    for (const Vector2& point : world.centre_line) {
        length += (point - previous).norm();
        previous = point;
    }
    EXPECT_NEAR(length, 200, 1e-9);  // the corners are among the points
}

class FileWorld : public ::testing::Test {
  protected:
    WorldParameters of(const std::string& text) {
        WorldParameters p;
        p.kind = WorldKind::file;
        p.file = folder_.write("world.csv", text);
        return p;
    }

  private:
    const test::TemporaryFolder folder_;
};

TEST_F(FileWorld, TakesIdsAndPositionsFromTheTable) {
    const World world = makeWorld(of("x,id,y\n1.5,7,-2\n3,4,0.25\n"), 1);
    ASSERT_EQ(world.landmarks.size(), 2u);
    EXPECT_EQ(world.landmarks.at(SourceId{7}), Vector2(1.5, -2));
    EXPECT_EQ(world.landmarks.at(SourceId{4}), Vector2(3, 0.25));
}

TEST_F(FileWorld, IsThinnedByTheOrderOfItsRows) {
    WorldParameters p = of("id,x,y\n9,0,0\n3,1,0\n4,2,0\n1,3,0\n");
    p.file_every = 3;
    const World world = makeWorld(p, 1);
    ASSERT_EQ(world.landmarks.size(), 2u);
    EXPECT_EQ(world.landmarks.count(SourceId{9}) + world.landmarks.count(SourceId{1}), 2u);
}

TEST_F(FileWorld, RefusesWhatIsNoLandmark) {
    EXPECT_THROW(makeWorld(of("id,x,y\n1,2,3\n1,4,5\n"), 1), LogError);
    EXPECT_THROW(makeWorld(of("id,x,y\n-1,2,3\n"), 1), LogError);
    EXPECT_THROW(makeWorld(of("id,x,y\n1,inf,3\n"), 1), LogError);
    EXPECT_THROW(makeWorld(of("id,x\n1,2\n"), 1), LogError);
}

}  // namespace world_test
}  // namespace slamot::sim

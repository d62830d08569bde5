#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "ImmScenes.h"
#include "slamot/core/estimation/TargetModes.h"
#include "support/Expect.h"

namespace slamot {
namespace mode_chain_test {

using test::immModes;
using test::messageOf;
using test::near;

TEST(ModeChainTest, StayingIsTheDefault) {
    ImmParameters imm = immModes("a:cv:1, b:ca:1, c:ct:1:10");
    const Eigen::MatrixXd p = chainOf(imm).over(imm.transition_interval);
    const Eigen::Matrix3d expected = Eigen::Matrix3d::Constant(0.015) + 0.955 * Eigen::Matrix3d::Identity();
    EXPECT_TRUE(near(p, expected, 1e-12));
    EXPECT_TRUE(near(initialProbabilities(imm), Eigen::Vector3d::Constant(1.0 / 3), 1e-15));
    EXPECT_EQ(chainOf({}).over(7), Eigen::MatrixXd::Ones(1, 1));
}

TEST(ModeChainTest, OtherLengthsArePowers) {
    Eigen::Matrix3d p;
    p << 0.9, 0.06, 0.04, 0.1, 0.85, 0.05, 0.02, 0.08, 0.9;
    const ModeChain chain(p, 0.2);
    EXPECT_TRUE(near(chain.over(0.2), p, 1e-12));
    EXPECT_TRUE(near(chain.over(0.6), p * p * p, 1e-12));
    EXPECT_TRUE(near(chain.over(0.1) * chain.over(0.1), p, 1e-12));
    EXPECT_TRUE(near(chain.over(0), Eigen::Matrix3d::Identity(), 0));
    // Two modes in closed form: p_11(t) = pi_1 + pi_2 (1 - a - b)^(t / interval), pi_1 = b / (a + b).
    const double a = 0.1, b = 0.3;
    const ModeChain two((Eigen::Matrix2d() << 1 - a, a, b, 1 - b).finished(), 0.5);
    EXPECT_NEAR(two.over(0.8)(0, 0), 0.75 + 0.25 * std::pow(0.6, 1.6), 1e-12);
}

TEST(ModeChainTest, WithoutAnIntervalItHoldsForEachPrediction) {
    const Eigen::Matrix2d p = (Eigen::Matrix2d() << 0.2, 0.8, 0.7, 0.3).finished();
    const ModeChain chain(p, 0);
    for (const double dt : {0.0, 0.1, 5.0}) EXPECT_EQ(chain.over(dt), p);
}

TEST(ModeChainTest, RefusesWhatIsNoChain) {
    const auto refusal = [](const Eigen::MatrixXd& p, double interval) {
        return messageOf<std::invalid_argument>([&] { ModeChain(p, interval); });
    };
    EXPECT_NE(refusal((Eigen::Matrix2d() << 0.9, 0.1, 0.2, 0.9).finished(), 0).find("row 2"),
              std::string::npos);
    EXPECT_NE(refusal((Eigen::Matrix2d() << 1.1, -0.1, 0.2, 0.8).finished(), 0).find("row 1"),
              std::string::npos);
    // A negative eigenvalue, a zero one, and a mode reached only through another in less than no time.
    const auto in_time = [&](const Eigen::MatrixXd& p) {
        EXPECT_NO_THROW(ModeChain(p, 0));
        EXPECT_NE(refusal(p, 0.1).find("continuous time"), std::string::npos) << p;
    };
    in_time((Eigen::Matrix2d() << 0.2, 0.8, 0.8, 0.2).finished());
    in_time((Eigen::Matrix2d() << 0.5, 0.5, 0.5, 0.5).finished());
    in_time((Eigen::Matrix3d() << 0.8, 0.2, 0, 0, 0.8, 0.2, 0, 0, 1).finished());
    // Absorbing modes are legal.
    EXPECT_NO_THROW(ModeChain((Eigen::Matrix2d() << 1, 0, 0.1, 0.9).finished(), 0.1));
}

TEST(ModeChainTest, NumbersMustFitTheModes) {
    ImmParameters imm = immModes("a:cv:1, b:ca:1");
    imm.transition = {{0.9, 0.1}};
    EXPECT_NE(messageOf<std::invalid_argument>([&] { chainOf(imm); }).find("2 rows of 2"), std::string::npos);
    imm.transition = {{0.9, 0.1, 0.2, 0.8}};
    EXPECT_TRUE(near(chainOf(imm).over(0.15), (Eigen::Matrix2d() << 0.9, 0.1, 0.2, 0.8).finished(), 1e-12));
    imm.initial = {{0.3, 0.6}};
    EXPECT_NE(messageOf<std::invalid_argument>([&] { initialProbabilities(imm); }).find("0.9"),
              std::string::npos);
}

TEST(ImmParametersTest, ModesAreReadAndWritten) {
    ImmParameters imm;
    ParameterTable table("modes", "");
    describe(imm, table);
    const Parameter& modes = *table.find("modes");
    EXPECT_FALSE(modes.parse("straight:cv:0.5 , hard_left : ct:0.3:20,u:unicycle:1:7.5, v:unicycle:1"));
    ASSERT_EQ(imm.modes.size(), 4u);
    EXPECT_EQ(imm.modes[1].name, "hard_left");
    EXPECT_EQ(imm.modes[1].model.kind, TargetModelKind::ct);
    EXPECT_EQ(imm.modes[1].model.noise_std, 0.3);
    EXPECT_NEAR(imm.modes[1].model.turn_rate, 20 * pi / 180, 1e-15);
    EXPECT_NEAR(imm.modes[2].model.turn_rate_std, 7.5 * pi / 180, 1e-15);
    EXPECT_EQ(modes.print(), "straight:cv:0.5, hard_left:ct:0.3:20, u:unicycle:1:7.5, v:unicycle:1:10");
    imm.noise_interval = 0.25;
    for (const TargetModel& model : modelsOf(imm)) EXPECT_EQ(model.noise_interval, 0.25);

    const Parameter& transition = *table.find("transition");
    EXPECT_EQ(transition.print(), "auto");
    EXPECT_FALSE(transition.parse("0.9, 0.1, 0.2, 0.8"));
    EXPECT_EQ(transition.print(), "0.9, 0.1, 0.2, 0.8");
    for (const char* bad : {"", "0.9 0.1", "0.9,", "1.1", "-0.1", "x"})
        EXPECT_TRUE(transition.parse(bad)) << bad;
    EXPECT_FALSE(transition.parse("auto"));
    EXPECT_FALSE(imm.transition);
}

}  // namespace mode_chain_test
}  // namespace slamot

#include <gtest/gtest.h>

#include "../estimation/ImmScenes.h"
#include "slamot/core/estimation/BankedImm.h"
#include "slamot/core/estimation/DecoupledImm.h"
#include "slamot/core/filter/JointFilter.h"
#include "slamot/core/filter/ModalBelief.h"
#include "support/Expect.h"

namespace slamot {
namespace modal_belief_test {

using test::near;

ModalBelief started(ImmForm form, const std::string& modes, int most = 2) {
    JointFilterParameters p;
    if (!modes.empty()) p.imm = test::immModes(modes);
    ModalBelief out(settingsFrom(p, {}), form, most);
    out.start(makeJointBank(p.engine, {}, p.consistency, 1));
    return out;
}

template <class Form>
bool is(const ModalBelief& belief) {
    return dynamic_cast<const Form*>(&*belief) != nullptr;
}

RelativeGaussian at(double x) {
    return moverAt({Vector2(x, 1), 0.01 * Matrix2::Identity()}, 1, 1);
}

const std::string two_modes = "cv:cv:0.3, ca:ca:2";

TEST(ModalBeliefTest, AutomaticIsExactUntilThereAreTooMany) {
    ModalBelief belief = started(ImmForm::automatic, two_modes);
    EXPECT_TRUE(is<JointImm>(belief));
    const BlockId landmark = belief->addLandmark(RelativeGaussian{Vector2(3, 0), Matrix2::Identity()});
    const BlockId pose = belief->rememberPose();
    const BlockId a = *belief.addTarget(at(1)), b = *belief.addTarget(at(2));
    EXPECT_TRUE(is<JointImm>(belief));
    EXPECT_EQ(belief->bank().modeCount(), 4);

    const TargetBelief before = belief->target(b);
    const BlockId c = *belief.addTarget(at(3));
    EXPECT_TRUE(is<BankedImm>(belief));
    EXPECT_EQ(belief->bank().modeCount(), 1);
    EXPECT_TRUE(near(belief->target(b).mean, before.mean, 1e-12)) << "blocks keep their names";
    EXPECT_TRUE(near(belief->target(b).covariance, before.covariance, 1e-12));
    EXPECT_TRUE(near(belief->mean(landmark), Vector2(3, 0), 1e-12));
    EXPECT_EQ(belief->bank().kind(pose), BlockKind::pose);

    belief.removeTarget(b);
    belief.removeTarget(a);
    EXPECT_TRUE(is<BankedImm>(belief)) << "until all have ended";
    belief.removeTarget(c);
    EXPECT_TRUE(is<JointImm>(belief));
    EXPECT_TRUE(near(belief->mean(landmark), Vector2(3, 0), 1e-12));
    EXPECT_EQ(belief->bank().dimension(), 3 + 3 + 2);
    ASSERT_TRUE(belief.addTarget(at(4)));
    EXPECT_EQ(belief->bank().modeCount(), 2);
}

TEST(ModalBeliefTest, ExactTakesNoMoreThanItHasRoomFor) {
    ModalBelief belief = started(ImmForm::exact, two_modes);
    const BlockId a = *belief.addTarget(at(1));
    ASSERT_TRUE(belief.addTarget(at(2)));
    EXPECT_FALSE(belief.addTarget(at(3)));
    EXPECT_EQ(belief->bank().modeCount(), 4);
    EXPECT_EQ(belief->bank().dimension(), 3 + 12);
    belief.removeTarget(a);
    EXPECT_TRUE(belief.addTarget(at(3)));
}

TEST(ModalBeliefTest, OneModeHasRoomForAll) {
    for (const ImmForm form : {ImmForm::automatic, ImmForm::exact}) {
        ModalBelief belief = started(form, "", 1);
        for (int i = 0; i < 10; ++i) ASSERT_TRUE(belief.addTarget(at(i)));
        EXPECT_TRUE(is<JointImm>(belief));
    }
}

TEST(ModalBeliefTest, ScalableAndDecoupledStayWhatTheyAre) {
    ModalBelief scalable = started(ImmForm::scalable, two_modes),
                decoupled = started(ImmForm::decoupled, two_modes);
    for (ModalBelief* belief : {&scalable, &decoupled}) {
        std::vector<BlockId> targets;
        for (int i = 0; i < 4; ++i) targets.push_back(*belief->addTarget(at(i)));
        for (const BlockId target : targets) belief->removeTarget(target);
    }
    EXPECT_TRUE(is<BankedImm>(scalable));
    EXPECT_TRUE(is<DecoupledImm>(decoupled));
}

TEST(ModalBeliefTest, StartForgetsEverything) {
    ModalBelief belief = started(ImmForm::automatic, two_modes);
    for (int i = 0; i < 3; ++i) belief.addTarget(at(i));
    const JointFilterParameters p;
    belief.start(makeJointBank(p.engine, {}, p.consistency, 1));
    EXPECT_TRUE(is<JointImm>(belief));
    EXPECT_EQ(belief->bank().dimension(), 3);
    belief.addTarget(at(1));
    belief.addTarget(at(2));
    EXPECT_TRUE(is<JointImm>(belief)) << "old movers do not count";
}

}  // namespace modal_belief_test
}  // namespace slamot

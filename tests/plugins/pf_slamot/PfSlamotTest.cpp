#include <string>
#include <vector>

#include "conformance/Conformance.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace pf_slamot_test {

using test::messageOf;
using test::near;

const std::string exemption = "particles die out: what the filter has forgotten it takes for certain";

conformance::Options options(const std::string& config) {
    conformance::Options out;
    out.plugin = "pf_slamot";
    out.kind = conformance::Kind::sampled;
    out.config = config;
    out.nees_exemption = exemption;
    return out;
}

std::shared_ptr<Estimator> pf(const std::string& config) {
    const auto estimator = conformance::createSubject(options({}));
    estimator->initialize(Config::fromText(config, "my.ini"));
    return estimator;
}

// One particle at a known pose is one Kalman filter for the mover.
TEST(PfSlamotTest, OneParticleThatStandsStillByHand) {
    const auto estimator =
        pf("[motion]\nmodel = increment\nalong_std_per_sqrt_m = 0\nacross_std_per_sqrt_m = 0\n"
           "[pf_slamot]\nparticles = 1\n"
           "[pf_slamot.modes]\nmodes = cv:cv:0.5\nnoise_interval = 0\n"
           "[pf_slamot.target]\nvelocity_std = 3\n");
    estimator->start({});
    // First sight at (2, 0): P = diag(0.01, 2^2 * 0.0004); velocity 0 +- 3, acceleration 0 +- 2.
    estimator->update(test::detectionsAt(0, {test::seen({}, {2, 0}, ObjectKind::mover, 7)}));
    TrackEstimate track = estimator->tracks().at(0);
    EXPECT_EQ(track.source, SourceId{7});
    EXPECT_TRUE(near(track.mean, (Vector6() << 2, 0, 0, 0, 0, 0).finished(), 1e-12));
    EXPECT_TRUE(near(track.covariance,
                     Matrix6((Vector6() << 0.01, 0.0016, 9, 9, 4, 4).finished().asDiagonal()), 1e-12));
    // 0.1 s on: x has 0.01 + 0.1^2 9 + 0.5^2 (0.1^2 / 2)^2.
    estimator->predict(test::odometry(0, 0.1, {}));
    track = estimator->tracks().at(0);
    const double P_x = 0.01 + 0.09 + 6.25e-6, P_xv = 0.9 + 0.25 * 0.0005;
    EXPECT_NEAR(track.covariance(0, 0), P_x, 1e-12);
    EXPECT_NEAR(track.covariance(0, 2), P_xv, 1e-12);
    EXPECT_TRUE((track.covariance.bottomRows<2>().isZero(0)));
    // Seen 0.11 m farther: gains P / (P + 0.01).
    const auto report =
        estimator->update(test::detectionsAt(0.1, {test::seen({}, {2.11, 0}, ObjectKind::mover, 7)}));
    const double nu = 0.11;
    EXPECT_EQ(report.innovations.at(0).outcome, Outcome::updated);
    EXPECT_EQ(report.innovations.at(0).kind, ObjectKind::mover);
    EXPECT_NEAR(report.innovations.at(0).nis, nu * nu / (P_x + 0.01), 1e-9);
    track = estimator->tracks().at(0);
    EXPECT_NEAR(track.mean(0), 2 + P_x / (P_x + 0.01) * nu, 1e-9);
    EXPECT_NEAR(track.mean(2), P_xv / (P_x + 0.01) * nu, 1e-9);
    EXPECT_NEAR(track.covariance(0, 0), P_x * 0.01 / (P_x + 0.01), 1e-9);
    EXPECT_TRUE(estimator->robot().covariance.isZero(0));
}

TEST(PfSlamotTest, ModesAreNamedWhereThereAreSeveral) {
    EXPECT_TRUE(pf("")->modeNames().empty());
    const auto estimator = pf("[pf_slamot.modes]\nmodes = cv:cv:0.1, ca:ca:1\ninitial = 0.75, 0.25\n");
    EXPECT_EQ(estimator->modeNames(), (std::vector<std::string>{"cv", "ca"}));
    estimator->start({});
    estimator->update(test::detectionsAt(0, {test::seen({}, {2, 0}, ObjectKind::mover, 7)}));
    const TrackEstimate track = estimator->tracks().at(0);
    ASSERT_EQ(track.mode_probabilities.size(), 2u);
    EXPECT_NEAR(track.mode_probabilities[0], 0.75, 1e-12);
    EXPECT_TRUE(pf("[pf_slamot.modes]\nmodes = cv:cv:0.1, ca:ca:1\n[pf_slamot.target]\nmotion = control\n")
                    ->modeNames()
                    .empty());
}

TEST(PfSlamotTest, MistakesInTheModesAreSentences) {
    const std::string message =
        messageOf<ConfigError>([] { pf("[pf_slamot.modes]\nmodes = cv:cv:0.1, ca:ca:1\ninitial = 0.5\n"); });
    for (const std::string word : {"my.ini:1", "[pf_slamot.modes]", "1 numbers", "expected 2"})
        EXPECT_NE(message.find(word), std::string::npos) << message;
}

}  // namespace pf_slamot_test
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(pf_slamot, slamot::pf_slamot_test::options(""));
SLAMOT_CONFORMANCE_SUITE(pf_slamot_refined,
                         slamot::pf_slamot_test::options("[pf_slamot]\nproposal = refined\n"));
SLAMOT_CONFORMANCE_SUITE(
    pf_slamot_unscented,
    slamot::pf_slamot_test::options("[pf_slamot]\nproposal = refined\ntransform = unscented\n"));
SLAMOT_CONFORMANCE_SUITE(pf_slamot_modes,
                         slamot::pf_slamot_test::options("[pf_slamot.modes]\nmodes = cv:cv:0.2, ca:ca:1\n"));
SLAMOT_CONFORMANCE_SUITE(
    pf_slamot_control, slamot::pf_slamot_test::options(
                           "[pf_slamot.target]\nmotion = control\n[pf_slamot.association]\nmovers = jpda\n"));

#include "conformance/Conformance.h"
#include "support/Expect.h"

namespace slamot {
namespace imm_slamot_test {

using test::messageOf;

std::shared_ptr<Estimator> imm(const std::string& modes) {
    conformance::Options options;
    options.plugin = "imm_slamot";
    auto estimator = conformance::createSubject(options);
    estimator->initialize(Config::fromText("[imm_slamot.modes]\n" + modes + "\n", "my.ini"));
    return estimator;
}

TEST(ImmSlamotTest, ModesHeadTheirProbabilities) {
    const auto estimator =
        imm("modes = straight:cv:0.1, left:ct:0.2:20, right:ct:0.2:-20\ninitial = 0.5, 0.25, 0.25");
    EXPECT_EQ(estimator->modeNames(), (std::vector<std::string>{"straight", "left", "right"}));
    estimator->start({});
    DetectionSet set;
    auto& seen = std::get<RangeBearingSet>(set.measurements);
    seen.sensors.emplace_back();
    RangeBearingDetection detection;
    detection.range = 5;
    detection.covariance = Vector2(0.01, 0.0004).asDiagonal();
    detection.kind = ObjectKind::mover;
    detection.source = SourceId{3};
    seen.detections.push_back(detection);
    estimator->update(set);
    EXPECT_EQ(estimator->tracks().at(0).mode_probabilities, (std::vector<double>{0.5, 0.25, 0.25}));
}

TEST(ImmSlamotTest, MistakesInTheModesAreSentences) {
    for (const auto& [text, words] : std::vector<std::pair<std::string, std::vector<std::string>>>{
             {"modes = cv", {"my.ini:2", "name:model:noise_std"}},
             {"modes = cv:cv:0.5, cv:ca:1", {"my.ini:2", "different names"}},
             {"modes = turn:ct:0.5", {"my.ini:2", "turn_deg"}},
             {"modes = a b:cv:0.5", {"my.ini:2", "letters, digits"}},
             {"modes = cv:cv:0.5,", {"my.ini:2"}},
             {"modes = cv:cv:-1", {"my.ini:2"}},
             {"modes = cv:cv:0.5:3", {"my.ini:2"}},
             {"transition = 0.9, 0.1", {"my.ini:1", "2 numbers", "2 rows of 2"}},
             {"transition = 0.9, 0.1, 0.2, 0.9", {"my.ini:1", "row 2", "1.1", "sum to 1"}},
             {"transition = 0.2, 0.8, 0.8, 0.2", {"my.ini:1", "continuous time", "transition_interval = 0"}},
             {"transition = 1.5, 0, 0, 1", {"my.ini:2", "[0, 1]"}},
             {"initial = 0.5", {"my.ini:1", "1 numbers", "expected 2"}},
             {"initial = 0.5, 0.4", {"my.ini:1", "initial", "0.9"}}}) {
        const std::string message = messageOf<ConfigError>([&, text = text] { imm(text); });
        for (const std::string& word : words)
            EXPECT_NE(message.find(word), std::string::npos) << text << "\n" << message << "\nlacks " << word;
    }
    // The same swapping chain is legal where it holds for each prediction.
    EXPECT_NO_THROW(imm("transition = 0.2, 0.8, 0.8, 0.2\ntransition_interval = 0"));
}

conformance::Options classic() {
    conformance::Options options;
    options.plugin = "imm_slamot";
    options.config = "[imm_slamot]\nconsistency = classic\n";
    options.nees_exemption = "the classic core grows over-confident where bearings are rough";
    return options;
}

conformance::Options scalable() {
    conformance::Options options;
    options.plugin = "imm_slamot";
    options.config = "[imm_slamot]\nform = scalable\n";
    return options;
}

conformance::Options decoupled() {
    conformance::Options options;
    options.plugin = "imm_slamot";
    options.config = "[imm_slamot]\nform = decoupled\n";
    return options;
}

conformance::Options compressed() {
    conformance::Options options;
    options.plugin = "imm_slamot";
    options.config = "[imm_slamot]\nengine = compressed\n";
    return options;
}

conformance::Options threeModes() {
    conformance::Options options;
    options.plugin = "imm_slamot";
    options.config =
        "[imm_slamot]\nlikelihood = marginal\n"
        "[imm_slamot.modes]\nmodes = cv:cv:0.5, left:ct:0.5:15, right:ct:0.5:-15\n";
    return options;
}

}  // namespace imm_slamot_test
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(imm_slamot, slamot::conformance::Options{});
SLAMOT_CONFORMANCE_SUITE(imm_slamot_classic, slamot::imm_slamot_test::classic());
SLAMOT_CONFORMANCE_SUITE(imm_slamot_scalable, slamot::imm_slamot_test::scalable());
SLAMOT_CONFORMANCE_SUITE(imm_slamot_decoupled, slamot::imm_slamot_test::decoupled());
SLAMOT_CONFORMANCE_SUITE(imm_slamot_compressed, slamot::imm_slamot_test::compressed());
SLAMOT_CONFORMANCE_SUITE(imm_slamot_three_modes, slamot::imm_slamot_test::threeModes());

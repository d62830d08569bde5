#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "slamot/core/association/AssociationProblem.h"
#include "support/Expect.h"

namespace slamot {
namespace association_problem_test {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(AssociationProblem, FindsTheCandidatesOfADetection) {
    const AssociationProblem problem(4, 5, {{0, 2, 1, -1}, {2, 0, 1, -1}, {2, 4, 2, -2}});
    EXPECT_EQ(problem.detections(), 4);
    EXPECT_EQ(problem.candidates(), 3);
    EXPECT_EQ(problem.candidatesOf(0), 1);
    EXPECT_EQ(problem.candidatesOf(1), 0);
    EXPECT_EQ(problem.candidatesOf(2), 2);
    EXPECT_EQ(problem.candidatesOf(3), 0);
    EXPECT_EQ(problem.candidate(problem.first(2) + 1).object, 4);
}

TEST(AssociationProblem, RefusesWhatIsOutOfOrderOutOfRangeOrNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::vector<Candidate>> bad{
        {{1, 0, 1, 1}, {0, 0, 1, 1}},       {{0, 0, 1, 1}, {0, 0, 1, 1}}, {{0, 1, 1, 1}, {0, 0, 1, 1}},
        {{0, 0, 1, 1}, {2, 0, 1, 1}},       {{0, 0, 1, 1}, {0, 2, 1, 1}}, {{0, 0, 1, 1}, {0, 1, nan, 1}},
        {{0, 0, 1, 1}, {0, 1, 1, -1 / 0.0}}};
    for (const auto& candidates : bad) {
        const auto make = [&candidates] { AssociationProblem(2, 2, candidates); };
        EXPECT_THAT(test::messageOf<std::invalid_argument>(make), HasSubstr("candidate"));
    }
}

TEST(AssociationProblem, CertainDetectionsComeFirst) {
    // Two candidates; one, likely; none; one, likelier; one, as likely as the first of these.
    const AssociationProblem problem(
        5, 2, {{0, 0, 1, 5}, {0, 1, 1, 0}, {1, 0, 1, -2}, {3, 1, 1, -1}, {4, 1, 1, -2}});
    EXPECT_THAT(problem.unambiguousFirst(), ElementsAre(3, 1, 4, 0));
}

TEST(AssociationProblem, ClustersAreWhatCandidatesConnect) {
    // 0 - a, 3 - a, 3 - c; 2 - b; 1 - d, 4 - d, 4 - e; 5 and object 5 stand alone.
    const AssociationProblem problem(
        6, 6,
        {{0, 0, 1, 0}, {1, 3, 1, 0}, {2, 1, 1, 0}, {3, 0, 1, 0}, {3, 2, 1, 0}, {4, 3, 1, 0}, {4, 4, 1, 0}});
    const std::vector<Cluster> found = clusters(problem);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_THAT(found[0].detections, ElementsAre(0, 3));
    EXPECT_THAT(found[0].objects, ElementsAre(0, 2));
    EXPECT_THAT(found[1].detections, ElementsAre(1, 4));
    EXPECT_THAT(found[1].objects, ElementsAre(3, 4));
    EXPECT_THAT(found[2].detections, ElementsAre(2));
    EXPECT_THAT(found[2].objects, ElementsAre(1));
}

TEST(AssociationProblem, ALongChainIsOneCluster) {
    // Detection d goes with objects d and d + 1, listed so that groups grow from both ends and meet.
    std::vector<Candidate> candidates;
    for (int d = 0; d < 100; ++d)
        for (const int o : {d, d + 1}) candidates.push_back({d, (o * 37) % 101, 1, 0});
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return std::make_pair(a.detection, a.object) < std::make_pair(b.detection, b.object);
    });
    const std::vector<Cluster> found = clusters({100, 101, candidates});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].detections.size(), 100u);
    EXPECT_EQ(found[0].objects.size(), 101u);
}

}  // namespace association_problem_test
}  // namespace slamot

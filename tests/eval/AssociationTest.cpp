#include <gtest/gtest.h>

#include <cmath>

#include "Builders.h"
#include "slamot/eval/Association.h"
#include "slamot/eval/Landmarks.h"

namespace slamot::eval {
namespace association_test {

/// Detections one by one, each at its own stamp.
class Log {
  public:
    RunRecord run;
    Truth truth;

    Log& clutter() { return add("clutter", -1); }
    Log& landmark(std::int64_t id) { return add("landmark", id); }
    Log& mover(std::int64_t id) { return add("mover", id); }
    /// Where the last one went.
    Log& toLandmark(std::int64_t id, Outcome outcome = Outcome::updated) {
        last().landmark = {id};
        last().outcome = outcome;
        return *this;
    }
    Log& toTrack(std::int64_t id, Outcome outcome = Outcome::updated) {
        last().track = {id};
        last().outcome = outcome;
        return *this;
    }
    Innovation& last() { return run.innovations.back().innovation; }

  private:
    Log& add(const std::string& kind, std::int64_t id) {
        const auto t = static_cast<double>(run.innovations.size());
        truth.associations.push_back({at(t), 0, kind, SourceId{id}});
        run.innovations.push_back(innovation(t, "s", ObjectKind::unknown, Outcome::ignored, 1));
        return *this;
    }
};

TEST(Association, ByHand) {
    Log log;
    // Landmark 0 takes three detections of source 5, one of source 6 and one of clutter; source 5 has one
    // more, rejected, and one that started landmark 1, which nothing else went to.
    log.landmark(5).toLandmark(0, Outcome::initiated);
    log.landmark(5).toLandmark(0);
    log.landmark(6).toLandmark(0, Outcome::inflated);
    log.clutter().toLandmark(0);
    log.landmark(5).toLandmark(0);
    log.landmark(5).toLandmark(0, Outcome::rejected);
    log.landmark(5).toLandmark(1, Outcome::initiated);
    log.clutter();
    // Track 0 has mover 5, which is not landmark 5; mover 9 went nowhere.
    log.mover(5).toTrack(0, Outcome::initiated);
    log.mover(9);
    // Landmark 2 has seen nothing, landmark 1 stands for what landmark 0 does.
    log.run.landmarks = {landmark(0, -1, 0, 0), landmark(1, -1, 0, 0), landmark(2, -1, 0, 0)};
    const auto m = associationMetrics(log.run, log.truth);
    ASSERT_TRUE(m);
    EXPECT_EQ(m->used, 10);
    EXPECT_EQ(m->doubled_landmarks, 1);
    // Of six detections of landmarks, the three of source 5 in landmark 0.
    EXPECT_EQ(m->landmarks.detections, 6);
    EXPECT_EQ(m->landmarks.found, 3);
    // Six went into landmarks: three in 0 and the one in 1 are right, of source 6 and clutter not.
    EXPECT_EQ(m->landmarks.associated, 6);
    EXPECT_EQ(m->landmarks.right, 4);
    EXPECT_EQ(m->landmarks.clutter, 1);
    EXPECT_DOUBLE_EQ(m->landmarks.recall, 0.5);
    EXPECT_DOUBLE_EQ(m->landmarks.precision, 4 / 6.0);
    EXPECT_DOUBLE_EQ(m->movers.recall, 0.5);
    EXPECT_DOUBLE_EQ(m->movers.precision, 1);
    EXPECT_DOUBLE_EQ(m->all.recall, 4 / 8.0);
    EXPECT_DOUBLE_EQ(m->all.precision, 5 / 7.0);
}

TEST(Association, TiesGoToTheFirst) {
    Log log;
    // Landmark 0 has one of source 6, then one of source 5: it stands for 6. Source 6 has one in landmark 0
    // and one in landmark 1, which stands for it too: it is found in 0.
    log.landmark(6).toLandmark(0);
    log.landmark(5).toLandmark(0);
    log.landmark(6).toLandmark(1);
    const auto m = associationMetrics(log.run, log.truth);
    EXPECT_EQ(m->all.found, 1);
    EXPECT_EQ(m->all.right, 2);
}

TEST(Association, AnObjectOfClutterAloneIsAllWrong) {
    Log log;
    log.clutter().toLandmark(0);
    log.clutter().toLandmark(0);
    const auto m = associationMetrics(log.run, log.truth);
    EXPECT_EQ(m->all.precision, 0);
    EXPECT_TRUE(std::isnan(m->all.recall));
    EXPECT_TRUE(std::isnan(m->movers.precision));
}

TEST(Association, DetectionsAreFoundByTheirNumber) {
    // Two detections of one stamp, told in the other order.
    RunRecord run;
    for (const int detection : {1, 0}) {
        run.innovations.push_back(innovation(0, "s", ObjectKind::mover, Outcome::updated, 1, 10 + detection));
        run.innovations.back().innovation.detection = detection;
    }
    run.innovations.push_back(innovation(1, "s", ObjectKind::mover, Outcome::updated, 1, 11));
    Truth truth;
    truth.associations = {
        {at(0), 0, "mover", SourceId{0}}, {at(0), 1, "mover", SourceId{1}}, {at(1), 0, "mover", SourceId{1}}};
    EXPECT_EQ(associationMetrics(run, truth)->all.found, 3);
}

TEST(Association, LeavesOutStampsWhoseNumbersDoNotFit) {
    Log log;
    log.landmark(5).toLandmark(0);
    log.landmark(5).toLandmark(0);
    // Truth has a second detection at the first stamp: the run left one of the two out, who knows which.
    log.truth.associations.push_back({at(0), 1, "clutter", SourceId{}});
    // And one that truth does not know.
    log.run.innovations.push_back(innovation(9, "s", ObjectKind::unknown, Outcome::updated, 1));
    const auto m = associationMetrics(log.run, log.truth);
    EXPECT_EQ(m->used, 1);
    EXPECT_EQ(m->unnumbered, 1);
    EXPECT_EQ(m->without_truth, 1);
}

TEST(Association, TentativeDetectionsAreNeitherRightNorWrong) {
    Log log;
    log.landmark(5).last().outcome = Outcome::tentative;
    log.clutter().last().outcome = Outcome::tentative;
    log.mover(7).last().outcome = Outcome::tentative;
    // An estimator may say what it is kept for: no part of the estimate yet.
    log.landmark(6).toLandmark(0, Outcome::tentative);
    log.landmark(5).toLandmark(0, Outcome::initiated);
    log.landmark(5);  // ignored: recall pays
    const auto m = associationMetrics(log.run, log.truth);
    EXPECT_EQ(m->used, 6);
    EXPECT_EQ(m->landmarks.tentative, 2);
    EXPECT_EQ(m->movers.tentative, 1);
    EXPECT_EQ(m->all.tentative, 3);
    EXPECT_EQ(m->tentative_clutter, 1);
    EXPECT_EQ(m->landmarks.detections, 2);
    EXPECT_EQ(m->landmarks.found, 1);
    EXPECT_EQ(m->landmarks.associated, 1);
    EXPECT_EQ(m->landmarks.right, 1);
    EXPECT_EQ(m->movers.detections, 0);
    EXPECT_EQ(m->all.clutter, 0);
}

TEST(Association, TentativeDetectionsOfWhatIsInTheEstimateAreMisses) {
    // Ten looks at landmark 5: one goes into landmark 0, eight are left aside, one more is paired rightly. A
    // filter that leaves undecided what it has must not look the better for it.
    Log log;
    log.landmark(5).last().outcome = Outcome::tentative;  // before: neither right nor wrong
    log.landmark(5).toLandmark(0, Outcome::initiated);
    for (int i = 0; i < 7; ++i) log.landmark(5).last().outcome = Outcome::tentative;
    log.landmark(5).toLandmark(0);
    // Landmark 6 went into an object of another: it is not in the estimate.
    log.landmark(6).toLandmark(0);
    log.landmark(6).last().outcome = Outcome::tentative;
    const auto m = associationMetrics(log.run, log.truth);
    EXPECT_EQ(m->landmarks.tentative, 2);
    EXPECT_EQ(m->landmarks.detections, 10);
    EXPECT_EQ(m->landmarks.found, 2);
    EXPECT_DOUBLE_EQ(m->landmarks.recall, 0.2);
    EXPECT_DOUBLE_EQ(m->landmarks.precision, 2 / 3.0);
}

/// A detection that the log has at t = 0 under `number` of `count`, in landmark `landmark`.
InnovationRow numbered(int number, int count, std::int64_t landmark) {
    // The number among those the run took in, which tells nothing here.
    InnovationRow row = innovation(0, "s", ObjectKind::landmark, Outcome::updated, 1);
    row.innovation.detection = 0;
    row.innovation.landmark = {landmark};
    row.log = LogNumber{number, count};
    return row;
}

Truth threeLandmarks() {
    Truth truth;
    for (int i = 0; i < 3; ++i) truth.associations.push_back({at(0), i, "landmark", SourceId{10 + i}});
    return truth;
}

TEST(Association, NumbersInTheLogFindWhatIsLeftOfIt) {
    // The log's second detection was withheld, and two false ones added.
    RunRecord run;
    run.innovations = {numbered(-1, 3, 0), numbered(2, 3, 2), numbered(-1, 3, 7), numbered(0, 3, 0)};
    const auto m = associationMetrics(run, threeLandmarks());
    EXPECT_EQ(m->used, 4);
    EXPECT_EQ(m->without_truth, 0);
    EXPECT_EQ(m->unnumbered, 0);
    EXPECT_EQ(m->all.detections, 2);
    EXPECT_EQ(m->all.found, 2);
    EXPECT_EQ(m->all.associated, 4);
    EXPECT_EQ(m->all.right, 2);
    EXPECT_EQ(m->all.clutter, 2);
}

TEST(Association, AddedClutterCountsWhereTruthKnowsTheRestOfTheStamp) {
    RunRecord run;
    run.innovations = {numbered(0, 4, 0), numbered(3, 4, 1), numbered(-1, 4, 2)};
    const auto part = associationMetrics(run, threeLandmarks());  // which says nothing of number 3
    EXPECT_EQ(part->used, 1);
    EXPECT_EQ(part->without_truth, 2);
    EXPECT_EQ(part->all.clutter, 0);

    run.innovations = {numbered(-1, 0, 2)};  // the sensor saw nothing but clutter
    EXPECT_EQ(associationMetrics(run, threeLandmarks()).whyAbsent(),
              "the log had fewer detections than truth has at every stamp, so that their numbers do not fit");
    Truth elsewhere = threeLandmarks();
    for (TrueAssociation& association : elsewhere.associations) association.stamp = at(1);
    EXPECT_EQ(associationMetrics(run, elsewhere)->all.clutter, 1);
}

TEST(Association, ATruthOfMoreDetectionsThanTheLogHasFitsNot) {
    RunRecord run;
    run.innovations = {numbered(0, 2, 0), numbered(1, 2, 1), numbered(-1, 2, 1)};
    const auto m = associationMetrics(run, threeLandmarks());
    EXPECT_EQ(m.whyAbsent(),
              "the log had fewer detections than truth has at every stamp, so that their numbers do not fit");
}

TEST(Association, SaysWhatIsMissing) {
    Log log;
    EXPECT_EQ(associationMetrics(log.run, log.truth).whyAbsent(), "truth has no associations");
    log.landmark(5).toLandmark(0);
    Truth other = log.truth;
    other.associations[0].stamp = at(77);
    EXPECT_EQ(associationMetrics(log.run, other).whyAbsent(),
              "truth has no association of any detection of the run");
    log.truth.associations.push_back({at(0), 1, "clutter", SourceId{}});
    EXPECT_EQ(associationMetrics(log.run, log.truth).whyAbsent(),
              "the log had fewer detections than truth has at every stamp, so that their numbers do not fit");
    log.run.innovations.clear();
    EXPECT_EQ(associationMetrics(log.run, log.truth).whyAbsent(), "the run has no innovations");
}

TEST(MapCardinality, AgainstAllAndAgainstSeen) {
    RunRecord run;
    run.trajectory = {row(0, 0, 0, 0), row(1, 0, 0, 0)};
    run.landmarks = {landmark(0, -1, 0, 0), landmark(1, -1, 0, 0)};
    Truth truth;
    for (const std::int64_t id : {3, 4, 5, 6, 7}) truth.landmarks[SourceId{id}] = {0, 0};
    EXPECT_EQ(mapCardinality(run, truth)->error, -3);
    EXPECT_EQ(mapCardinality(run, truth)->seen.whyAbsent(),
              "truth has no associations, which would tell which landmarks were seen");
    // Landmark 3 seen twice; 4 after the run; a mover 5.
    truth.associations = {{at(0), 0, "landmark", SourceId{3}},
                          {at(0), 1, "mover", SourceId{5}},
                          {at(1), 0, "landmark", SourceId{3}},
                          {at(2), 0, "landmark", SourceId{4}}};
    const auto m = mapCardinality(run, truth);
    EXPECT_EQ(m->seen->landmarks, 1);
    EXPECT_EQ(m->seen->error, 1);
    EXPECT_EQ(mapCardinality({}, truth).whyAbsent(), "the run has no landmarks");
    EXPECT_EQ(mapCardinality(run, {}).whyAbsent(), "truth has no landmarks");
}

}  // namespace association_test
}  // namespace slamot::eval

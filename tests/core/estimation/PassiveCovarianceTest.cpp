#include <gtest/gtest.h>

#include <numeric>

#include "slamot/core/estimation/PassiveCovariance.h"
#include "support/Expect.h"
#include "support/RandomMatrices.h"

namespace slamot {
namespace passive_covariance_test {

using test::near;
using test::randomMatrix;

/// The blocks of five tiles beside the whole matrix.
class PassiveCovarianceTest : public testing::Test {
  protected:
    PassiveCovarianceTest() {
        for (int t = 0; t < static_cast<int>(width_.size()); ++t) {
            covariance_.addTile();
            first_.push_back(std::accumulate(width_.begin(), width_.begin() + t, 0));
        }
        whole_ = Eigen::MatrixXd::Zero(size(), size());
        for (int t = 0; t < 5; ++t)
            for (int s = 0; s <= t; ++s) {
                const Eigen::MatrixXd P = randomMatrix(random_, width_[s], width_[t]);
                covariance_.addProduct(s, t, Eigen::MatrixXd::Identity(width_[s], width_[s]),
                                       s == t ? Eigen::MatrixXd(P + P.transpose()) : P);
                addToWhole(s, t, s == t ? Eigen::MatrixXd(P + P.transpose()) : P);
            }
    }

    int size() const { return std::accumulate(width_.begin(), width_.end(), 0); }
    void addToWhole(int s, int t, const Eigen::MatrixXd& P) {
        whole_.block(first_[s], first_[t], width_[s], width_[t]) += P;
        if (s != t) whole_.block(first_[t], first_[s], width_[t], width_[s]) += P.transpose();
    }
    /// Tiles 0 and 1 near, the others far.
    WaitingTerm term(WaitingTerm::About about, int rank) {
        WaitingTerm out;
        out.about = about;
        out.scale = randomMatrix(random_, rank, 1);
        for (int t = 0; t < 5; ++t)
            out.parts.push_back({t > 1, about == WaitingTerm::About::two_far && t < 2
                                            ? Eigen::MatrixXd()
                                            : randomMatrix(random_, rank, width_[t])});
        for (int t = 0; t < 5; ++t)
            for (int s = 0; s <= t; ++s)
                if (out.touches(s, t))
                    addToWhole(s, t, out.part(s).F.transpose() * out.scale.asDiagonal() * out.part(t).F);
        return out;
    }
    void addTerms(int rank_of_two_far) {
        WaitingTerm near_and_far = term(WaitingTerm::About::near_and_far, 3);
        covariance_.addWaiting(std::move(near_and_far), term(WaitingTerm::About::two_far, rank_of_two_far));
    }
    /// Every pair of landmarks, and rows for three landmarks in two tiles.
    void expectAgreement() {
        for (int s = 0; s < 5; ++s)
            for (int t = 0; t < 5; ++t)
                for (int i = 0; i < width_[s]; i += 2)
                    for (int j = 0; j < width_[t]; j += 2)
                        ASSERT_TRUE(near(covariance_.covariance(s, i, t, j),
                                         whole_.block<2, 2>(first_[s] + i, first_[t] + j), 1e-11));
        const PassiveCovariance::Rows rows(covariance_, {{3, 2}, {1, 0}, {3, 0}});
        for (int t = 0; t < 5; ++t) {
            Eigen::MatrixXd expected(6, width_[t]);
            expected << whole_.block(first_[3] + 2, first_[t], 2, width_[t]),
                whole_.block(first_[1], first_[t], 2, width_[t]),
                whole_.block(first_[3], first_[t], 2, width_[t]);
            ASSERT_TRUE(near(rows.with(t, width_[t]), expected, 1e-11)) << t;
        }
    }

    RandomStream random_{1, RandomPurpose::test};
    std::vector<int> width_{6, 4, 8, 4, 10};
    std::vector<int> first_;
    PassiveCovariance covariance_;
    Eigen::MatrixXd whole_;
};

TEST_F(PassiveCovarianceTest, SaysTheSameWhileTermsWaitAndAreAdded) {
    // Ranks of 50 fill the gathered term in two and start the next, so that every kind of term waits at some
    // time, and is added in the midst of others.
    std::size_t most_waiting = 0;
    for (int group = 0; group < 12; ++group) {
        addTerms(50);
        for (int step = 0; step < 3; ++step) {
            most_waiting = std::max(most_waiting, static_cast<std::size_t>(covariance_.waiting()));
            ASSERT_NO_FATAL_FAILURE(expectAgreement()) << group << " " << step;
            covariance_.step();
        }
    }
    EXPECT_GE(most_waiting, 3U);
    for (int step = 0; step < 100; ++step) covariance_.step();
    EXPECT_LE(covariance_.waiting(), 1) << "what is being gathered goes on waiting";
    expectAgreement();
}

TEST_F(PassiveCovarianceTest, ForgetsCoordinatesEverywhere) {
    addTerms(100);
    addTerms(100);
    covariance_.step();
    covariance_.drop(2, {0, 1, 6, 7});
    Eigen::MatrixXd kept(size() - 4, size());
    const int gap = first_[2] + 2;
    kept << Eigen::MatrixXd::Identity(size(), size()).topRows(gap),
        Eigen::MatrixXd::Identity(size(), size()).bottomRows(size() - gap - 4);
    whole_ = kept * whole_ * kept.transpose();
    width_[2] = 4;
    for (int t = 3; t < 5; ++t) first_[t] -= 4;
    expectAgreement();
    for (int step = 0; step < 10; ++step) covariance_.step();
    expectAgreement();
    addTerms(60);
    expectAgreement();
}

TEST_F(PassiveCovarianceTest, ATileIsReplacedByAnother) {
    addTerms(100);
    covariance_.drop(3, {});
    covariance_.clearTile(3);
    whole_.middleRows(first_[3], width_[3]).setZero();
    whole_.middleCols(first_[3], width_[3]).setZero();
    expectAgreement();
    for (int step = 0; step < 10; ++step) covariance_.step();
    expectAgreement();
    addTerms(100);
    expectAgreement();
}

TEST_F(PassiveCovarianceTest, BlocksGrowAsLandmarksJoin) {
    PassiveCovariance covariance;
    covariance.addTile();
    covariance.addTile();
    covariance.add(1, 2, 0, 4, Matrix2::Identity());
    EXPECT_EQ(covariance.covariance(1, 2, 0, 4), Matrix2::Identity());
    EXPECT_EQ(covariance.covariance(0, 4, 1, 2), Matrix2::Identity());
    EXPECT_EQ(covariance.covariance(1, 0, 0, 0), Matrix2::Zero());
    EXPECT_EQ(covariance.covariance(1, 8, 0, 8), Matrix2::Zero()) << "beyond its size a block is zero";
    covariance.add(0, 0, 0, 0, 4 * Matrix2::Identity());
    EXPECT_EQ(covariance.longestStd(), 2);
}

}  // namespace passive_covariance_test
}  // namespace slamot

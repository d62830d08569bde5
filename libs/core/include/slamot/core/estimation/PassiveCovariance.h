#pragma once
// P_bb0 of the landmarks that a PassiveMap has put away: a block for every pair of tiles, and terms of low
// rank that are still to be added to them (doc/maths/compressed_engine.md). They are added in slices, step by
// step; who asks for a covariance before gets it with what is waiting.
#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "slamot/core/data/Pose2.h"
#include "slamot/core/estimation/WaitingTerm.h"

namespace slamot {

class PassiveCovariance {
    struct Queue;

  public:
    void addTile();
    /// The tile's place is taken by another one.
    void clearTile(int t);

    /// Adds P to the block of coordinates of s from `row` on and of t from `column` on.
    void add(int s, int row, int t, int column, const Eigen::Ref<const Eigen::MatrixXd>& P);
    /// P_st += A^t B.
    void addProduct(int s, int t, const MatrixIn& A, const MatrixIn& B);
    /// What a group of far tiles leaves when it ends. The next one is expected to end after as many steps.
    void addWaiting(WaitingTerm near_and_far, const WaitingTerm& two_far);
    /// One step's part of adding to blocks what is waiting.
    void step();

    /// Between two landmarks, each by its tile and its first coordinate there.
    Matrix2 covariance(int s, int row, int t, int column) const;
    /// Keeps these coordinates of the tile.
    void drop(int tile, const std::vector<int>& kept);
    /// Longest standard deviation of a landmark, roughly.
    double longestStd() const;

    /// Rows of P_bb0 for a few landmarks, two each.
    class Rows {
      public:
        struct Landmark {
            int tile, first;
        };
        Rows(const PassiveCovariance& covariance, const std::vector<Landmark>& landmarks);
        /// With all of tile t, which has `width` coordinates.
        Eigen::MatrixXd with(int t, int width) const;

      private:
        /// The landmarks of one tile.
        struct Group {
            int tile;
            std::vector<int> rows;         ///< their coordinates' rows in the result
            std::vector<int> coordinates;  ///< in the tile
        };
        struct Left {  ///< of the F of a term that waits, for one group
            const WaitingTerm* term;
            const Queue* adding;  ///< where the term is being added
            std::size_t group;
            Eigen::MatrixXd rows;
        };
        const PassiveCovariance* covariance_;
        std::vector<Group> groups_;
        std::vector<Left> left_;
    };

    /// Terms that wait.
    int waiting() const;
    std::size_t memory() const;

  private:
    /// Terms, the oldest being added to blocks pair by pair of tiles.
    struct Queue {
        std::deque<WaitingTerm> terms;
        int s = 0, t = 0;    ///< the next pair, s <= t
        double pending = 0;  ///< multiplications left
        double per_step = 0;
        std::int64_t steps = 0;  ///< since the last term came

        bool added(int a, int b) const;  ///< the oldest term to this pair
    };

    Eigen::MatrixXd& block(int s, int t) {
        return blocks_[static_cast<std::size_t>(t)][static_cast<std::size_t>(s)];
    }
    const Eigen::MatrixXd& block(int s, int t) const {
        return blocks_[static_cast<std::size_t>(t)][static_cast<std::size_t>(s)];
    }
    int tileCount() const { return static_cast<int>(blocks_.size()); }
    Eigen::MatrixXd& blockOfAtLeast(int s, int t, Eigen::Index rows, Eigen::Index cols);
    void gather(const WaitingTerm& two_far);
    void push(Queue& queue, WaitingTerm term);
    void work(Queue& queue, double multiplications);
    /// action(term, the queue whose oldest it is, else null) for all that wait.
    template <class Action>
    void forWaiting(const Action& action) const;
    template <class Action>
    void forWaiting(const Action& action);

    std::vector<std::vector<Eigen::MatrixXd>> blocks_;  ///< [t][s], s <= t; zero beyond its size
    Queue near_and_far_, two_far_;
    WaitingTerm gathering_;  ///< the next term of two_far_, from several groups
    int gathered_ = 0;       ///< its rows that are taken
};

}  // namespace slamot

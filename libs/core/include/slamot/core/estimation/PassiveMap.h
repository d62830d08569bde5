#pragma once
// The landmarks that a compressed joint state has put away: b = b0 + B^t beta + e, where beta is the base, which the
// modes keep with the active state, and e, with covariance P_bb0, is independent of everything else.
//
// How P_bb0 and B are kept (doc/maths/compressed_engine.md). Landmarks are grouped into tiles. What a tile has to do
// with far places takes few directions Y (r x w, orthonormal rows, closed under the quarter turn):
//
//   B_t = X_t Y_t,    P_st = D_st + Y_s^t Z_st Y_t.
//
// A commit adds B^t Psi B to P_bb0, which is X_s^t Psi X_t in Z_st, r_s x r_t numbers instead of w_s x w_t, and turns
// X_t into Phi X_t. D_st is touched only when a tile gets another Y. An open tile, one near the robot, has Y = I.
// The additions to Z wait in a queue and are made in slices by `work`, or at once for a tile that is opened. Y leaves
// out what is below rounding: directions with less than `tolerance` of a standard deviation.
#include <cstdint>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "slamot/core/data/Pose2.h"
#include "slamot/core/estimation/Blocks.h"

namespace slamot {

class PassiveMap {
  public:
    /// `turning`: base rows come in pairs, the second turned by a quarter turn (the invariant core).
    explicit PassiveMap(bool turning) : turning_(turning) {}

    int size() const { return size_; }
    /// dim(beta), rows of B.
    int baseDimension() const { return q_; }
    bool contains(BlockId landmark) const;
    std::vector<BlockId> landmarks() const;

    /// b0 of a landmark.
    Vector2 mean(BlockId landmark) const;
    /// B_c, dim(beta) x 2.
    Eigen::MatrixXd base(BlockId landmark) const;
    /// P_bb0 between two landmarks.
    Matrix2 covariance(BlockId a, BlockId b) const;

    /// action(landmark, position) for every landmark, with the base at eta.
    template <class Action>
    void forPositions(const Eigen::Ref<const Eigen::VectorXd>& eta, const Action& action) const {
        for (const Tile& t : tiles_) {
            if (t.landmarks.empty()) continue;
            Eigen::VectorXd position = t.X.transpose() * eta;
            if (!t.open()) position = t.Y.transpose() * position;
            position += t.mean;
            for (std::size_t i = 0; i < t.landmarks.size(); ++i)
                action(t.landmarks[i], Vector2(position.segment<2>(2 * static_cast<Eigen::Index>(i))));
        }
    }

    /// Landmarks on their way to the active state, two coordinates each.
    struct Taken {
        Eigen::VectorXd mean;        ///< b0
        Eigen::MatrixXd base;        ///< B_c, of the base before
        Eigen::MatrixXd covariance;  ///< P_cc0
        int new_rows = 0;            ///< by which the base has grown, at its end
    };
    /// Their covariances P_cr0 with the landmarks that stay become rows at the end of the base, in their order;
    /// where rows come in pairs, each is followed by its turned one.
    Taken take(const std::vector<BlockId>& landmarks);

    /// Forgets a landmark.
    void remove(BlockId landmark);

    /// A new base, and landmarks that are put away.
    struct Commit {
        Eigen::MatrixXd Phi;       ///< P of the kept active coordinates with beta
        Eigen::MatrixXd Psi;       ///< P of beta
        Eigen::VectorXd eta;       ///< mean of beta
        Eigen::VectorXd kept_std;  ///< standard deviations of the kept coordinates; 0 for known ones
        std::vector<BlockId> landmarks;
        Eigen::VectorXd mean;              ///< of the landmarks put away
        Eigen::MatrixXd Phi_landmarks;     ///< their P with beta
        Eigen::MatrixXd kept_covariance;   ///< P of the kept active coordinates with them
        Eigen::MatrixXd own_covariance;    ///< P of them
    };
    /// b0 += B^t eta, P_bb0 += B^t Psi B, then B has the covariances of the kept coordinates as its rows. Tiles that
    /// have become far from the kept coordinates get another Y.
    void commit(const Commit& commit);
    /// [m] How far from a tile's centre a landmark that joins it may lie.
    void setTileReach(double reach) { tile_reach_ = reach; }

    /// Makes additions to Z that are waiting, about `multiplications` of them.
    void work(double multiplications);

    /// Numbers kept on the heap.
    std::size_t memory() const;
    struct Census {
        int tiles = 0, open = 0, directions = 0, columns = 0, waiting = 0;
        std::int64_t closings = 0, openings = 0, extensions = 0;
    };
    Census census() const;

  private:
    struct Tile {
        std::vector<BlockId> landmarks;  ///< none: the place is free
        Eigen::VectorXd mean;
        Eigen::MatrixXd X;  ///< q x r
        Eigen::MatrixXd Y;  ///< r x w, orthonormal rows; empty while the tile is open
        int directions_at_closing = 0;
        std::int64_t next_try = 0, pause = 0;  ///< closing is tried from this commit on; commits to the one after

        bool open() const { return Y.size() == 0; }
        int rank() const { return static_cast<int>(X.cols()); }
        int width() const { return 2 * static_cast<int>(landmarks.size()); }
        Vector2 centre() const;
    };
    struct Pair {  ///< of tiles s <= t
        Eigen::MatrixXd Z;      ///< r_s x r_t
        Eigen::MatrixXd D;      ///< w_s x w_t; empty: zero
        std::int64_t done = 0;  ///< number of the first commit not yet in Z
    };
    /// A commit's addition to P_bb0.
    struct Waiting {
        std::int64_t number;
        Eigen::MatrixXd X, Psi;                ///< X of all tiles side by side
        std::vector<std::pair<int, int>> span;  ///< first column and count, by tile
    };
    struct Address {
        BlockId landmark;
        int tile, index;
    };

    const Address& find(BlockId landmark) const;
    void index();
    Pair& pair(int s, int t) { return pairs_[static_cast<std::size_t>(t)][static_cast<std::size_t>(s)]; }
    const Pair& pair(int s, int t) const { return pairs_[static_cast<std::size_t>(t)][static_cast<std::size_t>(s)]; }
    Tile& tile(int t) { return tiles_[static_cast<std::size_t>(t)]; }
    const Tile& tile(int t) const { return tiles_[static_cast<std::size_t>(t)]; }
    bool used(int t) const { return !tiles_[static_cast<std::size_t>(t)].landmarks.empty(); }
    int tileCount() const { return static_cast<int>(tiles_.size()); }
    /// For every used tile s: action(s, pair, whether the tile t stands at the pair's columns).
    template <class Action>
    void forPairsOf(int t, const Action& action) {
        for (int s = 0; s < tileCount(); ++s)
            if (used(s)) action(s, s <= t ? pair(s, t) : pair(t, s), s <= t);
    }

    /// The additions of one commit to pairs (s, t), for s < end.
    void add(const Waiting& waiting, int t, int end);
    void settle(int t);
    void open(int t);
    bool close(int t);
    void closeTiles();
    /// Takes columns out of an open tile.
    void drop(int t, const std::vector<int>& gone);
    int tileFor(const Vector2& position);
    void appendColumns(int t, const std::vector<int>& which, const Commit& commit, const Eigen::MatrixXd& V,
                       const Waiting& addition, std::vector<std::vector<int>>& appended);
    /// P_c,t0 in the coordinates of tile t, whose Y grows where it has to.
    Eigen::MatrixXd rowsIn(int t, const std::vector<Address>& taken, const Eigen::VectorXd& std);
    Eigen::MatrixXd withTurned(const Eigen::MatrixXd& rows) const;

    bool turning_;
    int size_ = 0, q_ = 0;
    Eigen::VectorXd row_std_;  ///< of the coordinate behind each base row
    std::vector<Tile> tiles_;
    std::vector<std::vector<Pair>> pairs_;  ///< [t][s], s <= t
    std::vector<Address> addresses_;        ///< by landmark
    std::deque<Waiting> waiting_;
    std::int64_t commits_ = 0;
    double tile_reach_ = std::numeric_limits<double>::infinity();
    int next_closing_ = 0;  ///< the tile to look at first
    Eigen::MatrixXd product_, addition_;  ///< work space
    int next_tile_ = 0;  ///< where `work` goes on in the oldest of waiting_
    Census counts_;
};

}  // namespace slamot

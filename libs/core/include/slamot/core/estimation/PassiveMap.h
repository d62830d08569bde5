#pragma once
// The landmarks that a compressed joint state has put away: b = b0 + B^t beta + e, where beta is the base,
// which the modes keep with the active state, and e, with covariance P_bb0, is independent of everything
// else.
//
// How B is kept (doc/maths/compressed_engine.md). Landmarks stand in tiles of neighbours. Tiles near the
// robot have their columns X_t of B; all the others are one FarGroup. A commit, P_bb0 += B^t Psi B, goes into
// the covariances of near tiles at once and waits in the group for the others. When the robot has moved on,
// the tiles are grouped anew, and the PassiveCovariance takes over what waits in the old group. The group
// leaves out directions that say next to nothing (negligibleLength).
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "slamot/core/data/Pose2.h"
#include "slamot/core/estimation/Blocks.h"
#include "slamot/core/estimation/FarGroup.h"
#include "slamot/core/estimation/PassiveCovariance.h"

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
    /// action(landmark, position) for every landmark near the robot, with the base at eta.
    template <class Action>
    void forNearPositions(const Eigen::Ref<const Eigen::VectorXd>& eta, const Action& action) const {
        for (const Tile& t : tiles_) {
            if (t.landmarks.empty() || t.far) continue;
            const Eigen::VectorXd position = t.mean + t.X.topRows(q_).transpose() * eta;
            for (std::size_t i = 0; i < t.landmarks.size(); ++i)
                action(t.landmarks[i], Vector2(position.segment<2>(2 * static_cast<Eigen::Index>(i))));
        }
    }

    /// Landmarks on their way to the active state, two coordinates each.
    struct Taken {
        std::vector<BlockId> landmarks;
        Eigen::VectorXd mean;        ///< b0
        Eigen::MatrixXd base;        ///< B_c, of the base before
        Eigen::MatrixXd covariance;  ///< P_cc0
        Eigen::MatrixXd root;  ///< (P_cc0 - U_c^t U_c)^1/2: their formal covariance with the new rows proper
        int new_rows = 0;      ///< by which the base grows, at its end
    };
    /// Landmarks that differ from one another, and what the base does not know of them: what its rows proper,
    /// U, do not say of their covariances P_cr0 with the landmarks that stay, P_cr0 - U_c^t U_r, becomes rows
    /// at the end of the base, whitened; where rows come in pairs, each is followed by its turned one. The
    /// base grows by these rows in `take`; until then nobody sees them, and every other change but a grouping
    /// forgets them.
    Taken prepare(const std::vector<BlockId>& landmarks);
    /// What was prepared last leaves.
    void take(const Taken& taken);

    /// Forgets a landmark.
    void remove(BlockId landmark);
    /// Forgets the base, when nothing is here.
    void clear();

    /// A new base, and landmarks that are put away.
    struct Commit {
        Eigen::MatrixXd Psi;   ///< P of beta
        Eigen::VectorXd eta;   ///< mean of beta
        Eigen::MatrixXd rows;  ///< the new base's rows proper, made of those before: rows B
        std::vector<BlockId> landmarks;
        Eigen::VectorXd mean;        ///< of the landmarks put away
        Eigen::MatrixXd base;        ///< their columns of the new base's rows proper
        Eigen::MatrixXd Phi;         ///< their P with beta
        Eigen::MatrixXd covariance;  ///< P of them
    };
    /// b0 += B^t eta, P_bb0 += B^t Psi B, then B <- rows B.
    void commit(const Commit& commit);

    /// Where the robot is and how far its sensors reach [m], for the choice of near tiles. Groups anew when
    /// the robot has moved far enough; at a moment that is `busy` only when it
    /// cannot wait.
    void follow(const Vector2& robot, double reach, bool busy);

    /// One step's part of the work on covariances that wait.
    void step() { covariance_.step(); }

    /// Bytes of covariances and base.
    std::size_t memory() const;
    struct Census {
        int tiles = 0, near = 0, near_columns = 0, columns = 0, directions = 0, waiting = 0;
        std::int64_t regroupings = 0, added_terms = 0;
    };
    Census census() const;
    std::int64_t regroupings() const { return regroupings_; }

  private:
    struct Tile {
        std::vector<BlockId> landmarks;  ///< none: the place is free
        Eigen::VectorXd mean;
        bool far = false;
        Eigen::MatrixXd X;  ///< near: B's columns

        int width() const { return 2 * static_cast<int>(landmarks.size()); }
        Vector2 centre() const;
    };
    struct Address {
        int tile = -1, index = -1;  ///< none: not here
    };

    Tile& tile(int t) { return tiles_[static_cast<std::size_t>(t)]; }
    const Tile& tile(int t) const { return tiles_[static_cast<std::size_t>(t)]; }
    int tileCount() const { return static_cast<int>(tiles_.size()); }
    bool used(int t) const { return !tile(t).landmarks.empty(); }
    const Address& find(BlockId landmark) const;
    void index(int t);
    /// The base's rows, of its rows proper and the other way round.
    Eigen::MatrixXd withTurned(const Eigen::MatrixXd& proper) const;
    Eigen::MatrixXd rowsProper(const Eigen::MatrixXd& rows) const;
    /// far[t] where the tile's centre is far from all these places.
    std::vector<char> farFrom(const std::vector<Vector2>& places) const;

    /// The two coordinates of each landmark of a tile.
    static std::vector<int> coordinatesOf(const std::vector<int>& landmarks);
    /// Shorter rows of B, over all landmarks, say nothing.
    double negligibleLength() const;
    /// New rows of the base for landmarks that are to be taken, P_c,t0 - known^t U_t whitened.
    void addRows(const std::vector<Address>& taken, const Eigen::MatrixXd& known,
                 const Eigen::MatrixXd& whitener);
    void addFarRows(const PassiveCovariance::Rows& rows, const Eigen::MatrixXd& waiting,
                    const Eigen::MatrixXd& known, const Eigen::MatrixXd& whitener);
    void forgetPrepared();
    void drop(int t, const std::vector<int>& gone);
    int tileFor(const Vector2& position);
    /// What a commit adds to P_bb0.
    void addTerm(const Eigen::MatrixXd& Psi);
    void append(const Commit& commit, const Eigen::MatrixXd& near_rows, const Eigen::MatrixXd& far_rows,
                const std::vector<int>& first_column);
    /// Ends the present group; far are then the tiles for which far[t].
    void regroup(const std::vector<char>& far);

    bool turning_;
    int q_ = 0;
    int prepared_rows_ = 0;  ///< rows behind the q_ of the base
    std::vector<Tile> tiles_;
    std::vector<Address> addresses_;  ///< by landmark
    int size_ = 0;
    PassiveCovariance covariance_;  ///< without what waits in group_
    FarGroup group_;
    std::optional<Vector2> grouped_at_;  ///< where the robot was
    double reach_ = std::numeric_limits<double>::infinity();
    double landmark_std_ = 0;  ///< what tolerances refer to
    std::int64_t regroupings_ = 0;
};

}  // namespace slamot

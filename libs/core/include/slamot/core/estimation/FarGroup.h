#pragma once
// Far landmarks as one: what the base says about all of them takes few directions
// (doc/maths/compressed_engine.md).
#include <Eigen/Core>
#include <vector>

#include "slamot/core/estimation/WaitingTerm.h"

namespace slamot {

/// The far tiles of a PassiveMap: B_t = W V_t for a far tile t, V having rows in pairs, the second turned by
/// a quarter turn. They are orthonormal to half the digits, until landmarks leave; what W V says is exact in
/// any case. What commits have added to the covariances waits here:
///
///   P_st += V_s^t zeta V_t for far s and t,   P_st += C_s V_t for near s.
struct FarGroup {
    /// A tile. Far ones are as when the group was made, but for landmarks that left; near ones gain rows of C
    /// with every landmark.
    struct Part {
        bool far = false;
        Eigen::MatrixXd V;  ///< far: rank x width
        Eigen::MatrixXd C;  ///< near: width x rank
    };
    std::vector<Part> parts;  ///< by tile
    Eigen::MatrixXd W;        ///< rows of the base x rank
    Eigen::MatrixXd zeta;     ///< rank x rank
    Eigen::VectorXd shift;    ///< b0_t += V_t^t shift waits as well
    bool cut = false;         ///< landmarks of far tiles have left

    int rank() const { return static_cast<int>(W.cols()); }
    const Part& part(int tile) const { return parts[static_cast<std::size_t>(tile)]; }
    Part& part(int tile) { return parts[static_cast<std::size_t>(tile)]; }

    /// What waits for P of coordinates [first, first + count) of tile s with all of far tiles t is left()
    /// V_t.
    Eigen::MatrixXd left(int s, int first, int count) const;
    /// More directions, orthogonal to those that are here: rows of V for every far tile, to be filled in;
    /// nothing yet along them.
    void extend(int directions);
    void dropColumns(int tile, const std::vector<int>& kept);

    /// When the group ends: what it has to say about two far tiles. It goes with the square of what is known
    /// along V, so most of zeta's eigenvalues are below `negligible`.
    WaitingTerm aboutTwoFar(double negligible) const;
    /// And about a near and a far one; takes V and C.
    WaitingTerm takeNearAndFar();
};

}  // namespace slamot

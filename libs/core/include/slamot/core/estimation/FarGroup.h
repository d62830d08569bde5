#pragma once
// Far landmarks as one: what the base says about all of them takes few directions
// (doc/maths/compressed_engine.md).
#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace slamot {

/// The far tiles of a PassiveMap: B_t = W V_t for a far tile t, V having orthonormal rows in pairs, the
/// second turned by a quarter turn. What commits have added to the covariances waits here:
///
///   P_st += V_s^t zeta V_t for far s and t,   P_st += C_s V_t for near s.
struct FarGroup {
    /// A tile as it stood when the group was made; landmarks that joined it later are not part of it.
    struct Part {
        bool far = false;
        Eigen::MatrixXd V;  ///< far: rank x width
        Eigen::MatrixXd C;  ///< near: width x rank
        Eigen::MatrixXd E;  ///< far, once the group has ended: zeta's eigenvectors along V, few x width
    };
    std::int64_t number = 0;
    std::vector<Part> parts;  ///< by tile
    Eigen::MatrixXd W;        ///< rows of the base x rank
    Eigen::MatrixXd zeta;     ///< rank x rank
    Eigen::VectorXd lambda;   ///< eigenvalues that go with Part::E
    Eigen::VectorXd shift;    ///< b0_t += V_t^t shift waits as well

    int rank() const { return static_cast<int>(W.cols()); }
    bool far(int tile) const { return tile < static_cast<int>(parts.size()) && part(tile).far; }
    const Part& part(int tile) const { return parts[static_cast<std::size_t>(tile)]; }
    Part& part(int tile) { return parts[static_cast<std::size_t>(tile)]; }
    /// Landmark coordinates of a tile that the group knows.
    int width(int tile) const;

    /// What waits for P of coordinates [first, first + count) of tile s with all of far tiles t is left()
    /// V_t.
    Eigen::MatrixXd left(int s, int first, int count) const;
    /// The end of the group: nothing will be added to it. What it has to say about two far landmarks goes
    /// with the square of what is known along V, so most of zeta's eigenvalues are below `negligible`.
    void end(double negligible);
    /// For a group that has ended: what waits for P of tile s with tile t; nothing for two near ones.
    Eigen::MatrixXd waiting(int s, int t) const;
    /// The multiplications of that.
    double cost(int s, int t) const;

    /// Makes V's rows orthonormal again after tiles have left. What is below `negligible` in all of W V goes.
    void orthonormalise(double negligible);
    /// More directions: rows of V for every far tile, nothing yet along them.
    void extend(int directions);
    void dropColumns(int tile, const std::vector<int>& kept);
};

}  // namespace slamot

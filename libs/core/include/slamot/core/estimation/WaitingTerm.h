#pragma once
// A low-rank term of the covariance of what is put away that has not been added to its blocks yet.
#include <Eigen/Core>
#include <vector>

#include "slamot/core/estimation/DenseAlgebra.h"

namespace slamot {

/// P_st += F_s^t diag(scale) F_t for the pairs of tiles the term is about.
struct WaitingTerm {
    enum class About { near_and_far, two_far };
    /// A tile as it stood when the term came to be; landmarks that joined it later are not part of it.
    struct Part {
        bool far = false;
        Eigen::MatrixXd F;  ///< rank x width; no columns: the term is not about this tile
    };
    About about = About::two_far;
    std::vector<Part> parts;  ///< by tile
    Eigen::VectorXd scale;    ///< rank

    int rank() const { return static_cast<int>(scale.size()); }
    const Part& part(int tile) const { return parts[static_cast<std::size_t>(tile)]; }
    Part& part(int tile) { return parts[static_cast<std::size_t>(tile)]; }
    /// Landmark coordinates of a tile that the term knows.
    int width(int tile) const {
        return tile < static_cast<int>(parts.size()) ? static_cast<int>(part(tile).F.cols()) : 0;
    }
    /// Puts the rows of another term about the same pairs at `row`; all are there already, with scale 0.
    void put(int row, const WaitingTerm& other);
    bool touches(int s, int t) const;
    /// What waits for P of some coordinates of tile s with all of tile t is left() F_t; nothing for
    /// coordinates that the term does not know.
    Eigen::MatrixXd left(int s, const std::vector<int>& coordinates) const;
    /// P is at least as large as what the term knows of the two tiles.
    void addTo(int s, int t, MatrixOut P) const;
    /// The multiplications of that, and of all pairs together.
    double cost(int s, int t) const;
    double cost() const;
    void dropColumns(int tile, const std::vector<int>& kept);
};

}  // namespace slamot

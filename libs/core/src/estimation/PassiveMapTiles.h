#pragma once
// Small matrix edits for the tiles of a PassiveMap.
#include <Eigen/Core>

#include <vector>

namespace slamot::passive_map {

/// The two coordinates of each landmark of a tile.
inline std::vector<int> coordinatesOf(const std::vector<int>& landmarks) {
    std::vector<int> out;
    for (const int i : landmarks) {
        out.push_back(2 * i);
        out.push_back(2 * i + 1);
    }
    return out;
}

/// Y's columns of a landmark, r x 2; an empty Y is the identity.
inline Eigen::MatrixXd columnsOf(const Eigen::MatrixXd& Y, int rank, int landmark) {
    if (Y.size() > 0) return Y.middleCols<2>(2 * landmark);
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rank, 2);
    out.middleRows<2>(2 * landmark).setIdentity();
    return out;
}

/// M T at the columns of a pair, T^t M at its rows.
inline void transformSide(Eigen::MatrixXd& M, const Eigen::MatrixXd& T, bool at_columns) {
    M = at_columns ? Eigen::MatrixXd(M * T) : Eigen::MatrixXd(T.transpose() * M);
}

inline void appendZeros(Eigen::MatrixXd& M, int count, bool at_columns) {
    const auto rows = M.rows(), cols = M.cols();
    if (at_columns) {
        M.conservativeResize(rows, cols + count);
        M.rightCols(count).setZero();
    } else {
        M.conservativeResize(rows + count, cols);
        M.bottomRows(count).setZero();
    }
}

inline void keepSide(Eigen::MatrixXd& M, const std::vector<int>& kept, bool at_columns) {
    M = at_columns ? Eigen::MatrixXd(M(Eigen::all, kept)) : Eigen::MatrixXd(M(kept, Eigen::all));
}

}  // namespace slamot::passive_map

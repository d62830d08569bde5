#pragma once
// Optimal assignment: which row goes with which column at the least total cost.
#include <Eigen/Core>
#include <limits>
#include <vector>

namespace slamot {

/// The cost of a pair that must not be made.
inline constexpr double forbidden_pair = std::numeric_limits<double>::infinity();

struct Assignment {
    /// For each row its column, or -1.
    std::vector<int> column_of_row;
    /// Number of pairs, and the sum of their costs as given (not rounded).
    int pairs = 0;
    double cost = 0;
};

/// Of the assignments with the most pairs, one of least total cost, for a matrix of any shape with finite
/// costs of either sign or `forbidden_pair`. To let a row stay alone at a price, add a column for it.
/// Deterministic: the same matrix gives the same assignment, ties included.
///
/// Costs are rounded to integers for the solver, in steps of at most (largest - smallest cost) times
/// max(2^-50, 2^-60 (min(rows, columns) + 1) (rows + columns + 1)): the result is optimal up to `pairs`
/// steps. Throws std::invalid_argument for a cost that is NaN or -infinity.
Assignment optimalAssignment(const Eigen::MatrixXd& cost);

}  // namespace slamot

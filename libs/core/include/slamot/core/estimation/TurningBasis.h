#pragma once
// Bases for the rows of a matrix whose columns are the coordinates of points, two each; closed under the
// quarter turn: row 2k + 1 is row 2k turned.
#include <Eigen/Core>
#include <vector>

namespace slamot {

/// Every 2-vector of a row turned by a quarter turn to the left: rows (I x J)^t.
Eigen::MatrixXd turnedRows(const Eigen::Ref<const Eigen::MatrixXd>& rows);
/// Every row followed by its turned one.
Eigen::MatrixXd withTurnedRows(const Eigen::Ref<const Eigen::MatrixXd>& rows);

/// The first row of every pair.
Eigen::MatrixXd firstOfPairs(const Eigen::MatrixXd& rows);

/// Orthonormal rows that span `rows` to within `tolerance` (the length of what is left of any row), closed
/// under the quarter turn.
Eigen::MatrixXd turningBasis(Eigen::MatrixXd rows, double tolerance);

/// Rows over many points, cut into parts of some of the points each.
using CutRows = std::vector<Eigen::MatrixXd>;
using CutRowsView = std::vector<const Eigen::MatrixXd*>;

/// W V = W' V' with the rows of V' orthonormal, where V is closed under the quarter turn. V' is not made
/// until it is asked for; V has to live as long.
class OrthonormalRows {
  public:
    /// What is below `negligible` in all of W V goes.
    OrthonormalRows(const Eigen::MatrixXd& W, const CutRowsView& V, double negligible);

    /// W'.
    const Eigen::MatrixXd& W() const { return W_; }
    int rank() const { return static_cast<int>(W_.cols()); }
    /// K V' for a K that is closed under the quarter turn, pairs of its columns being points.
    CutRows times(const Eigen::MatrixXd& K) const;

  private:
    /// Takes out of `rest` what lies along V'; gives rest V'^t.
    Eigen::MatrixXd deflate(CutRows& rest) const;

    CutRowsView V_;
    Eigen::MatrixXd W_;
    Eigen::MatrixXd many_;  ///< V' = [many V; few]
    CutRows few_;
};

/// rows = along V + weights directions, for rows whose turned ones matter as much, and V orthonormal, closed
/// under the quarter turn: the directions are so too, and orthogonal to V, however little of the rows they
/// make up.
struct BeyondBasis {
    Eigen::MatrixXd along, weights;
    CutRows directions;

    /// `count` rows, cut as V is, perhaps into no part at all. What is below `negligible` in all of them
    /// goes.
    BeyondBasis(const CutRowsView& V, const CutRows& rows, Eigen::Index count, double negligible);
};

}  // namespace slamot

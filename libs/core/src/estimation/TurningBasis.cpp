#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {

Eigen::MatrixXd turnedRows(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    Eigen::MatrixXd out(rows.rows(), rows.cols());
    for (Eigen::Index j = 0; j + 1 < rows.cols(); j += 2) {
        out.col(j) = -rows.col(j + 1);
        out.col(j + 1) = rows.col(j);
    }
    return out;
}

Eigen::MatrixXd turningBasis(Eigen::MatrixXd rows, double tolerance, int largest) {
    // Gram-Schmidt with the longest remaining row first, each pivot orthogonalised twice.
    Eigen::MatrixXd basis(largest, rows.cols());
    int rank = 0;
    while (true) {
        Eigen::Index longest = 0;
        if (rows.rows() == 0 || rows.rowwise().squaredNorm().maxCoeff(&longest) <= tolerance * tolerance)
            break;
        if (rank + 2 > largest) return Eigen::MatrixXd(0, rows.cols());
        const auto found = basis.topRows(rank);
        Eigen::MatrixXd pair(2, rows.cols());
        pair.row(0) = rows.row(longest).normalized();
        pair.row(0) -= (pair.row(0) * found.transpose()) * found;
        pair.row(0).normalize();
        pair.row(1) = turnedRows(pair.row(0));
        rows -= (rows * pair.transpose()) * pair;
        rows.row(longest).setZero();
        basis.middleRows<2>(rank) = pair;
        rank += 2;
    }
    return basis.topRows(rank);
}

}  // namespace slamot

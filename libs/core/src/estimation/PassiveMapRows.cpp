// What the base gains when landmarks of a PassiveMap become active: rows that say what the base did not know
// of their covariances with those that stay.
#include "slamot/core/estimation/PassiveMap.h"
#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {

void PassiveMap::findRows(const Eigen::MatrixXd& whitener, Taken& taken) const {
    const Eigen::MatrixXd known = rowsProper(taken.base);
    std::vector<PassiveCovariance::Rows::Landmark> landmarks;
    Eigen::MatrixXd waiting(taken.mean.size(), group_.rank());  // in the group, left of V
    for (const BlockId id : taken.landmarks) {
        const auto& [t, i] = find(id);
        waiting.middleRows<2>(2 * static_cast<Eigen::Index>(landmarks.size())) = group_.left(t, 2 * i, 2);
        landmarks.push_back({t, 2 * i});
    }
    const PassiveCovariance::Rows rows(covariance_, landmarks);
    taken.near_rows.resize(tiles_.size());
    for (int t = 0; t < tileCount(); ++t)
        if (used(t) && !tile(t).far)
            taken.near_rows[static_cast<std::size_t>(t)] = withTurned(product(
                whitener, rows.with(t, tile(t).width()) - transposedProduct(known, rowsProper(tile(t).X))));
    taken.far_rows = findFarRows(rows, waiting, known, whitener);
}

PassiveMap::Taken::FarRows PassiveMap::findFarRows(const PassiveCovariance::Rows& rows,
                                                   const Eigen::MatrixXd& waiting,
                                                   const Eigen::MatrixXd& known,
                                                   const Eigen::MatrixXd& whitener) const {
    // What of the rows lies along V, twice for rounding; what does not gives new directions.
    std::vector<int> far;
    CutRows rest;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t) || !tile(t).far) continue;
        far.push_back(t);
        rest.push_back(product(whitener, rows.with(t, tile(t).width())));
    }
    const Eigen::Index count = waiting.rows();
    Eigen::MatrixXd along = product(whitener, waiting - transposedProduct(known, rowsProper(group_.W)));
    for (int pass = 0; pass < 2 && group_.rank() > 0; ++pass) {
        Eigen::MatrixXd part = Eigen::MatrixXd::Zero(count, group_.rank());
        for (std::size_t i = 0; i < far.size(); ++i)
            part += productTransposed(rest[i], group_.part(far[i]).V);
        for (std::size_t i = 0; i < far.size(); ++i) rest[i] -= product(part, group_.part(far[i]).V);
        along += part;
    }

    Eigen::MatrixXd proper = Eigen::MatrixXd::Zero(count, 2 * count);
    for (Eigen::Index i = 0; i < count; ++i) proper(i, 2 * i) = 1;
    for (Eigen::MatrixXd& part : rest) part = withTurnedRows(part);
    CutRowsView left_over;
    for (const Eigen::MatrixXd& part : rest) left_over.push_back(&part);
    const OrthonormalRows orthonormal(proper, left_over, negligibleLength());
    const Eigen::MatrixXd K = turningBasis(orthonormal.W(), negligibleLength());
    CutRows directions = orthonormal.times(K);
    Taken::FarRows out;
    out.directions.resize(tiles_.size());
    for (std::size_t i = 0; i < far.size(); ++i)
        out.directions[static_cast<std::size_t>(far[i])].swap(directions[i]);
    Eigen::MatrixXd new_rows(count, group_.rank() + K.rows());
    new_rows << along, productTransposed(orthonormal.W(), K);
    out.W = withTurned(new_rows);
    return out;
}

void PassiveMap::addRows(const Taken& taken) {
    group_.extend(static_cast<int>(taken.far_rows.W.cols()) - group_.rank());
    const auto append = [](Eigen::MatrixXd& M, const Eigen::MatrixXd& rows) {
        M.conservativeResize(M.rows() + rows.rows(), Eigen::NoChange);
        M.bottomRows(rows.rows()) = rows;
    };
    append(group_.W, taken.far_rows.W);
    for (int t = 0; t < tileCount(); ++t) {
        const auto at = static_cast<std::size_t>(t);
        if (!used(t)) continue;
        if (!tile(t).far) {
            append(tile(t).X, taken.near_rows[at]);
        } else {
            const Eigen::MatrixXd& directions = taken.far_rows.directions[at];
            group_.part(t).V.bottomRows(directions.rows()) = directions;
        }
    }
}

}  // namespace slamot

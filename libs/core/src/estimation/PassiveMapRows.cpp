// What the base gains when landmarks of a PassiveMap become active: rows that say what the base did not know
// of their covariances with those that stay.
#include "slamot/core/estimation/PassiveMap.h"
#include "slamot/core/estimation/TurningBasis.h"

namespace slamot {

void PassiveMap::addRows(const std::vector<Address>& taken, const Eigen::MatrixXd& known,
                         const Eigen::MatrixXd& whitener) {
    const auto count = 2 * static_cast<Eigen::Index>(taken.size());
    std::vector<PassiveCovariance::Rows::Landmark> landmarks;
    Eigen::MatrixXd waiting(count, group_.rank());  // in the group, left of V
    for (const Address& address : taken) {
        const auto row = 2 * static_cast<Eigen::Index>(landmarks.size());
        landmarks.push_back({address.tile, 2 * address.index});
        waiting.middleRows<2>(row) = group_.left(address.tile, 2 * address.index, 2);
    }
    const PassiveCovariance::Rows rows(covariance_, landmarks);
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t) || tile(t).far) continue;
        Tile& own = tile(t);
        const Eigen::MatrixXd more = withTurned(
            product(whitener, rows.with(t, own.width()) - transposedProduct(known, rowsProper(own.X))));
        own.X.conservativeResize(q_ + more.rows(), Eigen::NoChange);
        own.X.bottomRows(more.rows()) = more;
    }
    addFarRows(rows, waiting, known, whitener);
}

void PassiveMap::addFarRows(const PassiveCovariance::Rows& rows, const Eigen::MatrixXd& waiting,
                            const Eigen::MatrixXd& known, const Eigen::MatrixXd& whitener) {
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
    const CutRows directions = orthonormal.times(K);
    group_.extend(static_cast<int>(K.rows()));
    for (std::size_t i = 0; i < far.size(); ++i) group_.part(far[i]).V.bottomRows(K.rows()) = directions[i];
    Eigen::MatrixXd new_rows(count, group_.rank());
    new_rows << along, productTransposed(orthonormal.W(), K);
    const Eigen::MatrixXd with_turned = withTurned(new_rows);
    group_.W.conservativeResize(q_ + with_turned.rows(), Eigen::NoChange);
    group_.W.bottomRows(with_turned.rows()) = with_turned;
}

}  // namespace slamot

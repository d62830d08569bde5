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
    // P_ct0 - U_c^t U_t first: both are large and nearly the same, and whitening scales up.
    const Eigen::MatrixXd along_V = waiting - transposedProduct(known, rowsProper(group_.W));
    std::vector<int> far;
    CutRowsView V;
    CutRows more;
    for (int t = 0; t < tileCount(); ++t) {
        if (!used(t) || !tile(t).far) continue;
        far.push_back(t);
        V.push_back(&group_.part(t).V);
        more.push_back(product(whitener, rows.with(t, tile(t).width()) + product(along_V, *V.back())));
    }

    // What of them lies along V, and new directions for the rest.
    const BeyondBasis parts(V, more, waiting.rows(), negligibleLength());
    const auto count = static_cast<int>(parts.weights.cols());
    group_.extend(count);
    for (std::size_t i = 0; i < far.size(); ++i)
        group_.part(far[i]).V.bottomRows(count) = parts.directions[i];
    Eigen::MatrixXd new_rows(waiting.rows(), group_.rank());
    new_rows << parts.along, parts.weights;
    const Eigen::MatrixXd with_turned = withTurned(new_rows);
    group_.W.conservativeResize(q_ + with_turned.rows(), Eigen::NoChange);
    group_.W.bottomRows(with_turned.rows()) = with_turned;
}

}  // namespace slamot

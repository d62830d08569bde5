#include "slamot/core/association/ChiSquare.h"

#include <boost/math/distributions/chi_squared.hpp>

namespace slamot {

double chiSquareQuantile(double probability, double degrees) {
    return boost::math::quantile(boost::math::chi_squared(degrees), probability);
}

double PairGates::operator()(int pairs) {
    for (auto next = static_cast<int>(gates_.size()); next <= pairs; ++next)
        gates_.push_back(chiSquareQuantile(probability_, 2.0 * next));
    return gates_[static_cast<std::size_t>(pairs)];
}

}  // namespace slamot

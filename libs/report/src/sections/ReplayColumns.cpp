#include "sections/ReplayColumns.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "page/CompactSpec.h"

namespace slamot::report {

void ReplayColumns::add(const char* name, double value, int digits) {
    nlohmann::json& column = columns_[name];
    if (column.is_null()) {
        column = nlohmann::json::array();
    }
    std::isfinite(value) ? column.push_back(rounded(value, digits)) : column.push_back(nullptr);
}

void ReplayColumns::point(const Vector2& p) {
    length("x", p.x());
    length("y", p.y());
}

void ReplayColumns::ellipse(const Matrix2& covariance) {
    const Eigen::SelfAdjointEigenSolver<Matrix2> eigen(covariance);
    const Vector2 along = eigen.eigenvectors().col(1);
    length("a", 3 * std::sqrt(std::max(0.0, eigen.eigenvalues()(1))));
    length("b", 3 * std::sqrt(std::max(0.0, eigen.eigenvalues()(0))));
    add("angle", std::atan2(along.y(), along.x()), 2);
}

void ReplayColumns::unknown(std::initializer_list<const char*> names) {
    for (const char* name : names) {
        add(name, std::nan(""), 0);
    }
}

}  // namespace slamot::report

#pragma once
// Jacobians by automatic differentiation, to hold closed forms against.
#include <ceres/jet.h>

#include <Eigen/Core>

namespace slamot::test {

/// d f / d x at x. `f` takes a column of N Jets and returns a column of Jets.
template <int N, class Function>
auto jacobian(const Function& f, const Eigen::Matrix<double, N, 1>& x) {
    using Jet = ceres::Jet<double, N>;
    Eigen::Matrix<Jet, N, 1> jets;
    for (int i = 0; i < N; ++i) jets(i) = Jet(x(i), i);
    const auto y = f(jets);
    constexpr int rows = decltype(f(jets))::RowsAtCompileTime;
    Eigen::Matrix<double, rows, N> J;
    for (int i = 0; i < rows; ++i) J.row(i) = y(i).v.transpose();
    return J;
}

}  // namespace slamot::test

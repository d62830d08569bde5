#pragma once
// Assertions that GoogleTest lacks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <string>

namespace slamot::test {

/// Every entry within `tolerance` of the expected one, relative to the largest expected entry (at least 1).
template <class A, class B>
testing::AssertionResult near(const Eigen::MatrixBase<A>& value, const Eigen::MatrixBase<B>& expected,
                              double tolerance) {
    if (value.rows() != expected.rows() || value.cols() != expected.cols())
        return testing::AssertionFailure() << "sizes differ: " << value.rows() << "x" << value.cols()
                                           << " and " << expected.rows() << "x" << expected.cols();
    if (value.size() == 0) return testing::AssertionSuccess();
    const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
    const double difference = (value - expected).cwiseAbs().maxCoeff();
    if (difference <= tolerance * scale) return testing::AssertionSuccess();  // also refuses NaN
    return testing::AssertionFailure()
           << "largest difference " << difference << " above " << tolerance * scale << "\nvalue\n"
           << value << "\nexpected\n"
           << expected;
}

/// What `action` throws as an `Error`; fails the test when it throws nothing or something else.
template <class Error, class Action>
std::string messageOf(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    } catch (const std::exception& error) {
        ADD_FAILURE() << "threw something else: " << error.what();
        return {};
    }
    ADD_FAILURE() << "threw nothing";
    return {};
}

}  // namespace slamot::test

#pragma once
// One line holds an estimator plugin to all laws of Laws.h:
//
//   SLAMOT_CONFORMANCE_SUITE(my_estimator, slamot::conformance::Options{});
#include <gtest/gtest.h>

#include <ostream>

#include "conformance/Subject.h"

namespace slamot::conformance {

/// For GoogleTest, which would print the bytes.
inline void PrintTo(const Options& options, std::ostream* out) {
    *out << options.plugin;
}
inline std::string pluginOf(const testing::TestParamInfo<Options>& test) {
    return test.param.plugin;
}

class Conformance : public testing::TestWithParam<Options> {};

/// The options with the suite's name as plugin, where they name none.
Options named(const std::string& suite, Options options);

}  // namespace slamot::conformance

/// `SUITE`: the plugin's name, or any name when the options name the plugin. Further arguments: Options.
#define SLAMOT_CONFORMANCE_SUITE(SUITE, ...)                                                   \
    using slamot::conformance::Conformance;                                                    \
    INSTANTIATE_TEST_SUITE_P(SUITE, Conformance,                                               \
                             testing::Values(slamot::conformance::named(#SUITE, __VA_ARGS__)), \
                             slamot::conformance::pluginOf)

#pragma once
// The estimator under test: how to make one, and what its author says about it.
#include <slamot/core/plugin/Estimator.h>

#include <functional>
#include <memory>
#include <string>

namespace slamot::conformance {

enum class Kind {
    deterministic,  ///< equal input gives equal output, seed or not: laws hold to rounding
    sampled         ///< answers depend on the seed: rotation and convergence hold on the average over seeds
};

struct Options {
    Kind kind = Kind::deterministic;
    /// Plugin name; empty: the suite's.
    std::string plugin;
    /// INI text of the plugin's own sections, where the defaults are not what the law worlds need. `[motion]`
    /// is set by the worlds.
    std::string config;
    /// Largest errors at the end of a noise-free run [m], [rad]. Not zero: a filter still weighs what it
    /// sees.
    double noise_free_position = 0.05, noise_free_heading = 0.005;
    /// Why the NEES law does not hold for this method. Must stand, word for word, in doc/plugins/<plugin>.md.
    std::string nees_exemption;
    /// Instead of the plugin registry: for the tests of the laws themselves.
    std::function<std::shared_ptr<Estimator>()> create;
};

/// A new, uninitialized object; loads the plugin from the registry's default folders.
std::shared_ptr<Estimator> createSubject(const Options& options);

}  // namespace slamot::conformance

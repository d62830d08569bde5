#pragma once
#include <cstdint>
#include <vector>

#include "slamot/rawlog/Truth.h"
#include "slamot/sim/Scenario.h"

namespace slamot::sim {

/// Where something that moves truly was, step by step. `mode` of a state names the model that led to it.
struct Trajectory {
    SourceId id;
    int first_step = 0;
    std::vector<TrueTarget> states;

    /// Null when it is not there.
    const TrueTarget* at(int step) const {
        const auto i = static_cast<std::size_t>(step - first_step);
        return step >= first_step && i < states.size() ? &states[i] : nullptr;
    }
};

/// Throws ConfigError when every draw left the arena.
Trajectory simulateMover(const Scenario& scenario, const MoverParameters& mover, std::uint64_t seed);

}  // namespace slamot::sim

#pragma once
#include <array>
#include <utility>

#include "slamot/study/Row.h"

namespace slamot::study {

/// The numbers of Cost by name.
inline constexpr std::array<std::pair<const char*, double Cost::*>, 9> cost_fields = {{
    {"wall_s", &Cost::wall_s},
    {"simulate_s", &Cost::simulate_s},
    {"cpu_s", &Cost::cpu_s},
    {"step_ms_mean", &Cost::step_ms_mean},
    {"step_ms_p50", &Cost::step_ms_p50},
    {"step_ms_p99", &Cost::step_ms_p99},
    {"step_ms_max", &Cost::step_ms_max},
    {"step_cpu_ms_mean", &Cost::step_cpu_ms_mean},
    {"memory_mb", &Cost::memory_mb},
}};

}  // namespace slamot::study

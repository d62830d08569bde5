#pragma once

namespace slamot::app {

/// Exit codes scripts rely on.
inline constexpr int exit_success = 0, exit_failed = 1, exit_bad_input = 2;

}  // namespace slamot::app

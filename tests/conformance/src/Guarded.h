#pragma once
#include <fmt/format.h>

#include <exception>

#include "conformance/Laws.h"

namespace slamot::conformance {

/// The law's verdict, or what it threw.
template <class Law>
Verdict guarded(const Law& law) {
    try {
        return law();
    } catch (const std::exception& error) {
        return fmt::format("an exception ended the run: {}", error.what());
    }
}

}  // namespace slamot::conformance

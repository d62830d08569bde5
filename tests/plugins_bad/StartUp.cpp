// A module whose start-up code misbehaves.
#include <slamot/core/plugin/PluginRecord.h>

#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "Words.h"

namespace {

[[maybe_unused]] int aborts() {
    std::abort();
}
[[maybe_unused]] int throws() {
    throw std::runtime_error("thrown at start-up");
}
[[maybe_unused]] int exits() {
    std::_Exit(0);
}
[[maybe_unused]] int prints() {
    std::cout << "printed at start-up" << std::endl;
    std::cerr << "printed at start-up" << std::endl;
    return 0;
}

[[maybe_unused]] const int on_load = ON_LOAD();

}  // namespace

SLAMOT_PLUGIN_RECORD(SLAMOT_TEXT(NAME), "slamot::" SLAMOT_TEXT(NAME), "estimator", "Misbehaves when loaded");

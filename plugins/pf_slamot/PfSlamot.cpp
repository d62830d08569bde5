#include "PfSlamot.h"

#include <stdexcept>

IMPLEMENTS_MRPT_OBJECT(PfSlamot, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> PfSlamot::onParameters() {
    return withMotion(describe(parameters_, name(),
                               "Particles over the robot's path, each with filters for landmarks and movers (paper 2)."));
}

void PfSlamot::onInitialize(const Config& config) {
    try {
        targetSettings(parameters_);
    } catch (const std::invalid_argument& error) {
        const std::string section = name() + ".modes";
        throw ConfigError(config.origin(section) + ": [" + section + "] " + error.what());
    }
}

void PfSlamot::onStart(const Start& start) {
    begin(start, parameters_, motion(), start.threads);
}

}  // namespace slamot

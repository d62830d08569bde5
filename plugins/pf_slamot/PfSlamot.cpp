#include "PfSlamot.h"

#include <stdexcept>

IMPLEMENTS_MRPT_OBJECT(PfSlamot, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> PfSlamot::onParameters() {
    std::vector<ParameterTable> tables{describe(motion_)};
    for (ParameterTable& table : describe(
             parameters_, name(),
             "Particles over the robot's path, each with filters for landmarks and movers (paper 2)."))
        tables.push_back(std::move(table));
    return tables;
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
    filter_ = std::make_unique<TargetParticleFilter>(parameters_, motion_, start.threads);
    filter_->start(start.pose, start.seed);
}

}  // namespace slamot

#include "ImmSlamot.h"

#include <stdexcept>

IMPLEMENTS_MRPT_OBJECT(ImmSlamot, Estimator, slamot)

namespace slamot {

ImmSlamot::ImmSlamot() {
    TargetMode cv{"cv", {}}, ca{"ca", {}};
    cv.model.kind = TargetModelKind::cv;
    cv.model.noise_std = 0.5;
    ca.model.kind = TargetModelKind::ca;
    ca.model.noise_std = 1.5;
    parameters_.imm.modes = {cv, ca};
}

std::vector<std::string> ImmSlamot::modeNames() const {
    std::vector<std::string> names;
    for (const TargetMode& mode : parameters_.imm.modes) names.push_back(mode.name);
    return names;
}

std::vector<ParameterTable> ImmSlamot::onParameters() {
    std::vector<ParameterTable> tables{describe(motion_)};
    for (ParameterTable& table : describeImm(
             parameters_, "imm_slamot",
             "Interacting multiple model filter over robot, movers and landmarks (paper 1, section 2.3)."))
        tables.push_back(std::move(table));
    return tables;
}

void ImmSlamot::onInitialize(const Config& config) {
    try {
        chainOf(parameters_.imm);
        initialProbabilities(parameters_.imm);
    } catch (const std::invalid_argument& error) {
        const std::string section = "imm_slamot.modes";
        throw ConfigError(config.origin(section) + ": [" + section + "] " + error.what());
    }
}

void ImmSlamot::onStart(const Start& start) {
    parameters_.engine.background = start.threads > 1;
    filter_ = std::make_unique<JointFilter>(parameters_, motion_);
    filter_->start(start.stamp, start.pose);
}

}  // namespace slamot

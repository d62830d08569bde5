#include "EkfSlamot.h"

IMPLEMENTS_MRPT_OBJECT(EkfSlamot, Estimator, slamot)

namespace slamot {

std::vector<ParameterTable> EkfSlamot::onParameters() {
    std::vector<ParameterTable> tables{describe(motion_)};
    for (ParameterTable& table : describe(
             parameters_, "ekf_slamot", "Joint EKF over robot, movers and landmarks (paper 1, section 2.2)."))
        tables.push_back(std::move(table));
    return tables;
}

void EkfSlamot::onStart(const Start& start) {
    parameters_.engine.background = start.threads > 1;
    filter_ = std::make_unique<JointFilter>(parameters_, motion_);
    filter_->start(start.stamp, start.pose);
}

}  // namespace slamot

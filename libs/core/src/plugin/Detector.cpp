#include "slamot/core/plugin/Detector.h"

#include <fmt/format.h>
#include <mrpt/obs/CObservation.h>

#include "DetectionCheck.h"

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Detector, mrpt::rtti::CObject, slamot)

namespace slamot {

Detector::Detector() : COutputLogger("Detector") {}
Detector::~Detector() = default;

void Detector::initialize(const Config& config) {
    setLoggerName(name());
    for (const ParameterTable& table : onParameters()) load(table, config);
    onInitialize(config);
    onReset();
}

Detected Detector::detect(const mrpt::obs::CObservation& scan, const PoseGaussian& predicted) {
    Detected found = onDetect(scan, predicted);
    const RangeBearingSet& set = found.detections;
    for (std::size_t i = 0; i < set.detections.size(); ++i)
        if (const std::string problem = problemOf(set.detections[i], set.sensors.size()); !problem.empty())
            throw DetectorError(fmt::format("{}: detection {} {}", name(), i, problem));
    return found;
}

}  // namespace slamot

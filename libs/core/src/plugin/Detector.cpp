#include "slamot/core/plugin/Detector.h"

#include <mrpt/obs/CObservation.h>

IMPLEMENTS_VIRTUAL_MRPT_OBJECT(Detector, mrpt::rtti::CObject, slamot)

namespace slamot {

Detector::Detector() : COutputLogger("Detector") {}
Detector::~Detector() = default;

void Detector::initialize(const Config& config) {
    setLoggerName(name());
    for (const ParameterTable& table : parameterTables()) load(table, config);
    reset();
}

}  // namespace slamot

#pragma once
#include <string>

#include "slamot/core/data/Detections.h"

namespace slamot {

/// What is wrong with a detection of a set with so many sensors, as "is ..."; empty when nothing is.
std::string problemOf(const RangeBearingDetection& detection, std::size_t sensors);

}  // namespace slamot

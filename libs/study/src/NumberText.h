#pragma once
// Numbers as tables show them.
#include <string>

#include "slamot/study/Analysis.h"
#include "slamot/study/AnalysisFile.h"

namespace slamot::study {

/// Stands where there is no number.
inline constexpr const char* no_number = "–";

/// Rounded to `digits` significant digits, but never before the point: 0.0123, 1.23, 12345. Very large and
/// very small ones as 1.2e+09.
std::string numberText(double value, int digits);

/// "mean ± half width", "median [low, high]", or "mean ± half width (median)"; without what does not exist.
std::string statisticText(const Statistic& statistic, Shown shown, int digits);

/// "12 % [7, 20]".
std::string rateText(const Rate& rate);
/// 0.123 as "12.3 %".
std::string percentText(double part);

}  // namespace slamot::study

#pragma once
#include <string>
#include <vector>

namespace slamot::study {

/// A number as CSVs hold it: the shortest text that reads back unchanged; empty for NaN.
std::string csvNumber(double value);
/// Comma-separated with a newline; quoted where RFC 4180 asks for it.
std::string csvLine(const std::vector<std::string>& fields);

}  // namespace slamot::study

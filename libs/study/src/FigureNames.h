#pragma once
#include <optional>
#include <string>

namespace slamot::study {

/// Whether a row can have a figure of that name: a slip must be found before the study has run.
bool isFigure(const std::string& name);
/// The figure whose name is nearest, if any is near.
std::optional<std::string> nearestFigure(const std::string& name);

}  // namespace slamot::study

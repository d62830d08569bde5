#pragma once
#include <optional>
#include <string>

namespace slamot::study {

/// What a figure or series measures, as far as there are units to show it in.
enum class Dimension { other, length, angle, time, part };
struct FigureUnit {
    Dimension dimension = Dimension::other;
    double si = 1;  ///< the figure's own unit in SI: 1e-3 for milliseconds
};
/// By the words of its name, as eval, Series.h and Cost give them. Counts, NEES, speeds and the like are
/// `other`.
FigureUnit unitOf(const std::string& figure);

/// Whether a row can have a figure of that name: a slip must be found before the study has run.
bool isFigure(const std::string& name);
/// The figure whose name is nearest, if any is near.
std::optional<std::string> nearestFigure(const std::string& name);

}  // namespace slamot::study

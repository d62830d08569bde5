#pragma once
// What benchmarks write: files, and pages of doc/results that are filled.
#include <filesystem>
#include <map>
#include <string>

#include "slamot/report/Figure.h"

namespace slamot::bench {

/// Text by mark; each ends with a newline.
using PageContents = std::map<std::string, std::string>;

void writeFile(const std::string& name, const std::string& text);

/// As SVG beside `stem`.
void drawSvg(const report::Figure& figure, const std::filesystem::path& stem);

/// Puts the contents at the marks `<!-- bench NAME MARK -->` of the page. Throws ConfigError for a mark that there is
/// nothing for.
void fillPage(const std::string& page, const std::string& name, const PageContents& contents);

/// The line that says when, where and by what a page was filled; `others`: part of the machine that others used.
std::string stampLine(const std::string& command, double others);

/// A panel with both axes logarithmic.
report::Panel logarithmicPanel(const std::string& over, const std::string& quantity, const std::string& unit);

/// A line through its points; both are left out where there is none.
void addCurve(report::Panel& panel, const std::string& label, const report::Points2& points,
              const std::string& colour, report::Dash dash = report::Dash::solid);

}  // namespace slamot::bench

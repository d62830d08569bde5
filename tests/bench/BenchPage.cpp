#include "BenchPage.h"

#include <fmt/format.h>

#include "slamot/core/Version.h"
#include "slamot/core/config/Config.h"
#include "slamot/rawlog/PartFile.h"
#include "slamot/report/FigureWriter.h"
#include "slamot/study/Page.h"

namespace slamot::bench {

void writeFile(const std::string& name, const std::string& text) {
    PartFile file(name);
    file.write(text);
    file.close();
}

void drawSvg(const report::Figure& figure, const std::filesystem::path& stem) {
    report::writeFigure(figure, stem, {false, true, false});
}

void fillPage(const std::string& page, const std::string& name, const PageContents& contents) {
    const std::string text = study::filledText(page, "bench", name, [&](const std::vector<std::string>& words) {
        const auto found = contents.find(fmt::format("{}", fmt::join(words, " ")));
        if (found == contents.end())
            throw ConfigError(fmt::format("'{}' is no mark of {}", fmt::join(words, " "), name));
        return found->second;
    });
    study::writePage(page, text);
}

std::string stampLine(const std::string& command, double others) {
    const study::Provenance here = study::provenanceHere(command);
    return fmt::format("Filled on {}, {}, {} cores, slamot {}; others used {:.1f} % of the machine: `{}`\n", here.date,
                       here.processor, here.cores, version, 100 * others, here.command);
}

report::Panel logarithmicPanel(const std::string& over, const std::string& quantity, const std::string& unit) {
    report::Panel panel;
    panel.height = 320;
    panel.x.label = over;
    panel.y.label = quantity;
    panel.y.unit = unit;
    panel.x.logarithmic = panel.y.logarithmic = true;
    return panel;
}

void addCurve(report::Panel& panel, const std::string& label, const report::Points2& points,
              const std::string& colour, report::Dash dash) {
    if (points.empty()) return;
    panel.layers.push_back(report::Line{label, points, colour, 1.5, dash});
    panel.layers.push_back(report::Points{"", points, colour, report::Symbol::dot, 6});
}

}  // namespace slamot::bench

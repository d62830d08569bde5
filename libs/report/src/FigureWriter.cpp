#include "slamot/report/FigureWriter.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ChildProcess.h"
#include "JsonText.h"
#include "SvgPaths.h"
#include "slamot/rawlog/PartFile.h"
#include "slamot/report/FigureSpec.h"

namespace slamot::report {
namespace {

namespace fs = std::filesystem;

/// Debian 12's vg2svg fails: node-vega lacks the build of the package `vega` that vega-cli loads. Its parts
/// are whole, and these are the ones a figure needs.
constexpr const char* vega_to_svg = R"js(
'use strict';
const {transforms} = require('vega-dataflow');
for (const part of ['vega-transforms', 'vega-view-transforms', 'vega-encode']) {
  Object.assign(transforms, require(part));
}
const {parse} = require('vega-parser'), {View} = require('vega-view');
const spec = JSON.parse(require('fs').readFileSync(0, 'utf8'));
new View(parse(spec), {renderer: 'none'}).toSVG().then(
    svg => process.stdout.write(svg),
    error => { console.error(String(error)); process.exitCode = 1; });
)js";
/// Where Debian's JavaScript packages are: node from elsewhere does not look there by itself.
constexpr const char* debian_modules = "/usr/share/nodejs";

fs::path withSuffix(const fs::path& stem, const char* suffix) {
    fs::path file = stem;
    file += suffix;  // replace_extension would cut 'run1.5'
    return file;
}

void writeText(const fs::path& file, const std::string& text) {
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.flush();
    if (!out) {
        throw ReportError(fmt::format("cannot write '{}'", file.string()));
    }
}

std::string readText(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

/// What another program writes: removed when half made, unless it was given its final name.
class DrawnFile {
  public:
    explicit DrawnFile(const fs::path& target) : target_(target.string()), part_(partOf(target_)) {}
    ~DrawnFile() {
        std::error_code ignored;
        fs::remove(part_, ignored);
    }
    DrawnFile(const DrawnFile&) = delete;
    DrawnFile& operator=(const DrawnFile&) = delete;
    const fs::path& path() const { return part_; }
    void finish() const { finishPart(target_); }

  private:
    std::string target_;
    fs::path part_;
};

ReportError missing(const fs::path& file, const char* what, const char* package) {
    return ReportError(fmt::format("'{}' was not drawn: {} is missing; install the Debian package {}",
                                   file.string(), what, package));
}

void drawSvg(const fs::path& spec, const fs::path& svg) {
    const DrawnFile part(svg);
    const ChildResult result =
        runChild({"node", "-e", vega_to_svg}, spec, part.path(), {{"NODE_PATH", debian_modules}});
    if (!result.started) {
        throw missing(svg, "the program node", "nodejs");
    }
    if (result.errors.find("Cannot find module 'vega-") != std::string::npos) {
        throw missing(svg, "Vega for node", "node-vega");
    }
    if (result.exit_code != 0) {
        throw ReportError(fmt::format("'{}' was not drawn: Vega says '{}'", svg.string(), result.errors));
    }
    writeText(part.path(), roundPathCoordinates(readText(part.path())));
    part.finish();
}

void drawPng(const fs::path& svg, const fs::path& png, double zoom) {
    const DrawnFile part(png);
    const ChildResult result = runChild({"rsvg-convert", "--format", "png", "--unlimited",
                                         "--background-color", "white", "--zoom", fmt::format("{}", zoom)},
                                        svg, part.path());
    if (!result.started) {
        throw missing(png, "the program rsvg-convert", "librsvg2-bin");
    }
    if (result.exit_code != 0) {
        throw ReportError(
            fmt::format("'{}' was not drawn: rsvg-convert says '{}'", png.string(), result.errors));
    }
    part.finish();
}

}  // namespace

void writeFigure(const Figure& figure, const fs::path& stem, const FigureFormats& formats) {
    const fs::path spec = withSuffix(stem, ".vg.json"), svg = withSuffix(stem, ".svg");
    if (stem.has_parent_path()) {
        std::error_code error;
        fs::create_directories(stem.parent_path(), error);
        if (error) {
            throw ReportError(
                fmt::format("cannot make the folder '{}': {}", stem.parent_path().string(), error.message()));
        }
    }
    writeText(spec, jsonText(figureSpec(figure)));
    if (formats.svg || formats.png) {
        drawSvg(spec, svg);
    }
    if (formats.png) {
        drawPng(svg, withSuffix(stem, ".png"), formats.png_zoom);
    }
    if (formats.png && !formats.svg) {
        fs::remove(svg);
    }
    if (!formats.spec) {
        fs::remove(spec);
    }
}

}  // namespace slamot::report

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "slamot/report/FigureSpec.h"
#include "slamot/report/FigureWriter.h"
#include "support/TemporaryFolder.h"

namespace slamot::report {
namespace figure_writer_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class FigureWriter : public ::testing::Test {
  protected:
    static Figure simpleFigure() {
        constexpr double nan = std::numeric_limits<double>::quiet_NaN();
        Figure figure;
        figure.title = "Title with <brackets> & \"quotes\"";
        figure.panels.emplace_back();
        figure.panels[0].layers = {Line{"a line", {{0, 1}, {1, 2}, {2, nan}, {3, 2}, {4, 1}}}};
        return figure;
    }
    static std::string textOf(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }
    /// Whether figures can be drawn here, else why not.
    std::string whyNotDrawn() const {
        try {
            writeFigure(simpleFigure(), folder_ / "trial");
        } catch (const ReportError& error) {
            return error.what();
        }
        return {};
    }

  private:
    const test::TemporaryFolder temporary_;

  protected:
    const fs::path folder_ = temporary_.path();
};

TEST_F(FigureWriter, aTitleThatIsNoUtf8IsReplaced) {
    Figure figure = simpleFigure();
    figure.title = "a \xFF label";
    writeFigure(figure, folder_ / "odd", {true, false, false});
    EXPECT_THAT(textOf(folder_ / "odd.vg.json"), HasSubstr("a \xEF\xBF\xBD label"));
}

#define SKIP_IF_NOT_DRAWN()                                            \
    if (const std::string reason = whyNotDrawn(); !reason.empty()) {   \
        ASSERT_THAT(reason, HasSubstr("install the Debian package ")); \
        GTEST_SKIP() << reason;                                        \
    }

/// Width and height in a PNG's header: big-endian at bytes 16 and 20.
std::pair<std::uint32_t, std::uint32_t> pngSize(const std::string& png) {
    const auto at = [&](std::size_t i) {
        std::uint32_t value = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            value = value << 8 | static_cast<unsigned char>(png.at(i + k));
        }
        return value;
    };
    return {at(16), at(20)};
}

TEST_F(FigureWriter, writesAllThreeFilesAtTheExpectedSize) {
    SKIP_IF_NOT_DRAWN();
    writeFigure(simpleFigure(), folder_ / "new folder" / "run1.5");
    const auto spec = nlohmann::json::parse(textOf(folder_ / "new folder" / "run1.5.vg.json"));
    const std::string svg = textOf(folder_ / "new folder" / "run1.5.svg");
    EXPECT_THAT(svg, HasSubstr("a line"));
    EXPECT_THAT(svg, HasSubstr("&lt;brackets&gt; &amp; "));
    const auto [width, height] = pngSize(textOf(folder_ / "new folder" / "run1.5.png"));
    EXPECT_EQ(width, 2 * 900u);  // the default width at the default zoom
    EXPECT_EQ(height, 2 * spec.at("height").get<unsigned>());
}

TEST_F(FigureWriter, aGapIsDrawnAsTwoPieces) {
    SKIP_IF_NOT_DRAWN();
    writeFigure(simpleFigure(), folder_ / "gap", {false, true, false});
    const std::string svg = textOf(folder_ / "gap.svg");
    // Two moves (M), each followed by one line (L): nothing is drawn across the gap or to the origin.
    const std::size_t line = svg.find("mark-line");
    ASSERT_NE(line, std::string::npos);
    const std::size_t begin = svg.find(" d=\"", line) + 4;
    const std::string path = svg.substr(begin, svg.find('"', begin) - begin);
    EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2) << path;
    EXPECT_EQ(std::count(path.begin(), path.end(), 'L'), 2) << path;
}

TEST_F(FigureWriter, namesMayHoldSpacesQuotesAndShellCharacters) {
    SKIP_IF_NOT_DRAWN();
    const fs::path stem = folder_ / "it's \"my\" run; $(echo x) & -o";
    writeFigure(simpleFigure(), stem);
    for (const char* suffix : {".vg.json", ".svg", ".png"}) {
        EXPECT_TRUE(fs::exists(stem.string() + suffix)) << suffix;
    }
}

TEST_F(FigureWriter, leavesOnlyWhatWasAskedFor) {
    SKIP_IF_NOT_DRAWN();
    fs::remove_all(folder_);
    writeFigure(simpleFigure(), folder_ / "only", {false, false, true});
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
        names.push_back(entry.path().filename().string());
    }
    EXPECT_EQ(names, std::vector<std::string>{"only.png"});
}

TEST_F(FigureWriter, everyKindOfLayerIsDrawn) {
    SKIP_IF_NOT_DRAWN();
    HeatMap heat;
    heat.label = "Heat";
    heat.values.setConstant(2, 3, 0.5);
    GaussianPoint gaussian;
    gaussian.covariance << 0.1, 0, 0, 0.2;
    Figure figure = simpleFigure();
    figure.panels[0].layers = {heat,
                               Band{"b", {{0, 0, 1}, {1, 0, 2}}},
                               Bars{"c", {{0, 1, 2}}},
                               Ellipses{"d", {gaussian}},
                               Line{"e", {{0, 0}, {1, 1}}},
                               Points{"f", {{0.5, 0.5}}, colour::green, Symbol::times},
                               Rule{"g", 0.5},
                               Texts{{{{0.2, 0.2}, "here"}}}};
    writeFigure(figure, folder_ / "all", {false, true, false});
    const std::string svg = textOf(folder_ / "all.svg");
    for (const char* sign : {"<image", "data:image/png;base64,", "mark-area", "mark-rect", "mark-line",
                             "mark-symbol", "mark-rule", ">here<", ">Heat<"}) {
        EXPECT_THAT(svg, HasSubstr(sign));
    }
    EXPECT_EQ(svg.find("NaN"), std::string::npos);
}

TEST_F(FigureWriter, aMissingProgramIsNamedAndTheSpecificationStays) {
    const std::string path = std::getenv("PATH");
    setenv("PATH", (folder_ / "no programs here").c_str(), 1);
    std::string message;
    try {
        writeFigure(simpleFigure(), folder_ / "f", {false, true, true});
    } catch (const ReportError& error) {
        message = error.what();
    }
    setenv("PATH", path.c_str(), 1);
    EXPECT_THAT(message, HasSubstr("the program node is missing; install the Debian package nodejs"));
    EXPECT_EQ(nlohmann::json::parse(textOf(folder_ / "f.vg.json")), figureSpec(simpleFigure()));
    EXPECT_FALSE(fs::exists(folder_ / "f.svg"));
    EXPECT_FALSE(fs::exists(folder_ / "f.svg.part"));
}

TEST_F(FigureWriter, aFolderThatCannotBeMadeIsAReportError) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "file") << "in the way";
    EXPECT_THROW(writeFigure(simpleFigure(), folder_ / "file" / "f"), ReportError);
}

}  // namespace figure_writer_test
}  // namespace slamot::report

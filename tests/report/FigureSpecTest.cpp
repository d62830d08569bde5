#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "slamot/report/FigureSpec.h"

namespace slamot::report {
namespace figure_spec_test {

using nlohmann::json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Figure withLayers(std::vector<Layer> layers) {
    Figure figure;
    figure.title = "A title";
    figure.panels.emplace_back();
    figure.panels.back().layers = std::move(layers);
    return figure;
}

/// The rows of a data set, by way of text: what a reader of the file gets.
json rowsOf(const Figure& figure, const std::string& name) {
    const json spec = json::parse(figureSpec(figure).dump());
    for (const json& set : spec.at("data")) {
        if (set.at("name") == name) {
            return set.at("values");
        }
    }
    return nullptr;
}

json markNamed(const json& spec, const std::string& name) {
    for (const json& mark : spec.at("marks")) {
        if (mark.value("name", "") == name) {
            return mark;
        }
    }
    return nullptr;
}

json domainOf(const json& panel, const std::string& scale) {
    for (const json& s : panel.at("scales")) {
        if (s.at("name") == scale) {
            return s.at("domain");
        }
    }
    return nullptr;
}

double number(const json& mark, const char* channel) {
    return mark.at("encode").at("update").at(channel).at("value").get<double>();
}

TEST(FigureSpec, layersKeepTheirRows) {
    const Figure figure =
        withLayers({Line{"line", {{0, 1}, {1, 3}, {2, 2}}}, Points{"points", {{0, 0}, {nan, 1}}},
                    Band{"band", {{0, -1, 1}, {2, -3, 3}}}, Bars{"bars", {{0, 1, 5}}}});
    EXPECT_EQ(rowsOf(figure, "p0_l0"),
              json::parse(R"([{"x":0.0,"y":1.0},{"x":1.0,"y":3.0},{"x":2.0,"y":2.0}])"));
    EXPECT_EQ(rowsOf(figure, "p0_l1").size(), 1u);  // the point without x has no place
    EXPECT_EQ(rowsOf(figure, "p0_l2")[1], json::parse(R"({"x":2.0,"low":-3.0,"high":3.0})"));
    EXPECT_EQ(rowsOf(figure, "p0_l3").size(), 1u);
}

TEST(FigureSpec, notANumberIsAGapNotAZero) {
    const Figure figure =
        withLayers({Line{"", {{0, 1}, {1, 1}, {2, nan}, {3, 1}, {nan, 2}, {nan, 3}, {4, 1}}}});
    const json rows = rowsOf(figure, "p0_l0");
    // Pieces of two, one and one points with a row of nulls between them.
    ASSERT_EQ(rows.size(), 6u);
    EXPECT_TRUE(rows[2]["x"].is_null() && rows[2]["y"].is_null());
    EXPECT_TRUE(rows[4]["x"].is_null() && rows[4]["y"].is_null());
    const json line = markNamed(figureSpec(figure), "panel_0").at("marks")[0];
    EXPECT_EQ(line["encode"]["update"]["defined"]["signal"], "isValid(datum.x) && isValid(datum.y)");
}

TEST(FigureSpec, nothingNotPositiveOnALogarithmicAxis) {
    Figure figure = withLayers({Line{"", {{1, 1}, {2, 0}, {3, 100}, {-4, 10}}}});
    figure.panels[0].x.logarithmic = figure.panels[0].y.logarithmic = true;
    figure.panels[0].x.padding = figure.panels[0].y.padding = 0;
    EXPECT_EQ(rowsOf(figure, "p0_l0").size(), 3u);  // two points and the gap between them
    const json domain = domainOf(markNamed(figureSpec(figure), "panel_0"), "y");
    EXPECT_NEAR(domain[0].get<double>(), 1, 1e-12);
    EXPECT_NEAR(domain[1].get<double>(), 100, 1e-10);
}

TEST(FigureSpec, equalAspect) {
    Figure figure = withLayers({Line{"", {{0, 0}, {100, 10}}}});
    figure.panels[0].equal_aspect = true;
    figure.panels[0].height = 333;
    const json panel = markNamed(figureSpec(figure), "panel_0");
    const json x = domainOf(panel, "x"), y = domainOf(panel, "y");
    const double per_metre_x = number(panel, "width") / (x[1].get<double>() - x[0].get<double>());
    const double per_metre_y = number(panel, "height") / (y[1].get<double>() - y[0].get<double>());
    EXPECT_NEAR(per_metre_x / per_metre_y, 1, 1e-12);
    EXPECT_EQ(number(panel, "height"), 333);
    EXPECT_LE(x[0].get<double>(), 0);
    EXPECT_GE(x[1].get<double>(), 100);
    EXPECT_NEAR((y[0].get<double>() + y[1].get<double>()) / 2, 5, 1e-12);  // data stay in the middle
}

TEST(FigureSpec, aFlatLineHasRoomAroundIt) {
    const auto domain = [](double value, std::optional<double> min) {
        Figure figure = withLayers({Line{"", {{0, value}, {1, value}}}});
        figure.panels[0].y.min = min;
        return domainOf(markNamed(figureSpec(figure), "panel_0"), "y");
    };
    EXPECT_EQ(domain(0, {}), json({-1.0, 1.0}));
    EXPECT_EQ(domain(10, {}), json({9.0, 11.0}));
    EXPECT_EQ(domain(0, 0.0), json({0.0, 1.0}));
    EXPECT_EQ(domain(-5, 0.0)[0], 0.0);  // the given end lies beyond the data
    EXPECT_GT(domain(-5, 0.0)[1].get<double>(), 0);
    Figure bars = withLayers({Bars{"", {{0, 1, 0}}}});
    EXPECT_EQ(domainOf(markNamed(figureSpec(bars), "panel_0"), "y"), json({-1.0, 1.0}));
}

TEST(FigureSpec, anAxisThatFallsIsRefused) {
    Figure figure = withLayers({});
    figure.panels[0].y.min = 2;
    figure.panels[0].y.max = 1;
    EXPECT_THROW(figureSpec(figure), std::invalid_argument);
}

TEST(FigureSpec, ellipsesAreClosedOutlinesAtThreeSigma) {
    GaussianPoint a, b;
    a.covariance << 1, 0.3, 0.3, 0.5;
    b.mean = {5, 5};
    b.covariance = a.covariance;
    const json rows = rowsOf(withLayers({Ellipses{"", {a, b}}}), "p0_l0");
    std::size_t outlines = 1;
    const Eigen::Matrix2d information = a.covariance.inverse();
    for (const json& row : rows) {
        if (row["x"].is_null()) {
            ++outlines;
            continue;
        }
        const Eigen::Vector2d p(row["x"].get<double>(), row["y"].get<double>());
        const Eigen::Vector2d d = p - (outlines == 1 ? a.mean : b.mean);
        EXPECT_NEAR(std::sqrt(d.dot(information * d)), 3, 1e-9);
    }
    EXPECT_EQ(outlines, 2u);
}

TEST(FigureSpec, longLinesAreDecimatedAndKeepTheirExtremes) {
    Points2 points;
    for (int i = 0; i < 50000; ++i) {
        points.emplace_back(i, i == 20001 ? 7.0 : i == 30001 ? -9.0 : 0.001 * (i % 7));
    }
    const json rows = rowsOf(withLayers({Line{"", points}}), "p0_l0");
    EXPECT_LE(rows.size(), 4 * 900u);  // four points for each of fewer than 900 columns
    double low = 0, high = 0;
    for (const json& row : rows) {
        low = std::min(low, row["y"].get<double>());
        high = std::max(high, row["y"].get<double>());
    }
    EXPECT_EQ(low, -9);
    EXPECT_EQ(high, 7);
}

TEST(FigureSpec, aDivergedWayStaysWithinTheRenderersCoordinates) {
    Figure figure = withLayers({Line{"", {{0, 0}, {1, 1}, {1e12, 1e12}}}});
    figure.panels[0].x.max = figure.panels[0].y.max = 2;
    const json rows = rowsOf(figure, "p0_l0");
    ASSERT_EQ(rows.size(), 3u);
    // Cut 2000 pixels beyond a panel about 800 wide that shows 2 m, but still on the diagonal.
    EXPECT_LT(rows[2]["x"].get<double>(), 30);
    EXPECT_GT(rows[2]["x"].get<double>(), 2);
    EXPECT_NEAR(rows[2]["x"].get<double>(), rows[2]["y"].get<double>(), 1e-6);
}

TEST(FigureSpec, axesNameTheirUnits) {
    Figure figure = withLayers({Line{"", {{0, 0}, {1, 1}}}});
    figure.panels[0].x = timeAxis();
    figure.panels[0].y.label = "NEES";
    const json axes = markNamed(figureSpec(figure), "panel_0").at("axes");
    EXPECT_EQ(axes[0]["title"], "Time [s]");
    EXPECT_EQ(axes[1]["title"], "NEES");
}

TEST(FigureSpec, legendListsLabelledLayersOutsideThePanel) {
    const json spec =
        figureSpec(withLayers({Line{"first", {{0, 0}}}, Line{"", {{1, 1}}}, Rule{"second", 0.5}}));
    const json panel = markNamed(spec, "panel_0"), legend = markNamed(spec, "legend_0");
    std::vector<std::string> texts;
    for (const json& mark : legend.at("marks")) {
        if (mark.at("type") == "text") {
            texts.push_back(mark["encode"]["update"]["text"]["value"]);
        }
    }
    EXPECT_EQ(texts, (std::vector<std::string>{"first", "second"}));
    EXPECT_LE(number(legend, "y") + number(legend, "height"), number(panel, "y"));
}

TEST(FigureSpec, aSharedLegendListsEveryLabelOnceAbovePanelsWithoutOne) {
    Figure figure = withLayers({Line{"one", {{0, 0}, {1, 1}}}, Line{"two", {{0, 0}, {1, 1}}}});
    figure.panels.push_back(figure.panels[0]);
    figure.panels[1].layers.push_back(Line{"three", {{0, 0}, {1, 1}}});
    for (Panel& panel : figure.panels) {
        panel.legend = LegendPlace::none;
    }
    EXPECT_TRUE(markNamed(figureSpec(figure), "legend").is_null());
    figure.shared_legend = true;
    const json spec = figureSpec(figure);
    std::vector<std::string> labels;
    const json legend = markNamed(spec, "legend");
    for (const json& mark : legend.at("marks")) {
        if (mark.at("type") == "text") {
            labels.push_back(mark.at("encode").at("update").at("text").at("value"));
        }
    }
    EXPECT_EQ(labels, (std::vector<std::string>{"one", "two", "three"}));
    EXPECT_GT(number(markNamed(spec, "panel_0"), "y"), number(markNamed(spec, "legend"), "y"));
    EXPECT_TRUE(markNamed(spec, "legend_0").is_null());
}

std::vector<double> logarithmicTicks(double low, double high) {
    Figure figure = withLayers({Line{"", {{1, low}, {2, high}}}});
    figure.panels[0].y.logarithmic = true;
    figure.panels[0].y.min = low;
    figure.panels[0].y.max = high;
    const json panel = markNamed(figureSpec(figure), "panel_0");
    for (const json& axis : panel.at("axes")) {
        if (axis.at("scale") == "y") {
            return axis.at("values").get<std::vector<double>>();
        }
    }
    return {};
}

TEST(FigureSpec, aLogarithmicAxisHasAtLeastThreeLabels) {
    EXPECT_EQ(logarithmicTicks(1, 1000), (std::vector<double>{1, 10, 100, 1000}));
    EXPECT_EQ(logarithmicTicks(0.9, 11), (std::vector<double>{1, 2, 5, 10}));
    EXPECT_EQ(logarithmicTicks(1.5, 4.5), (std::vector<double>{2, 3, 4})) << "1, 2, 5 would leave one";
    EXPECT_EQ(logarithmicTicks(10.5, 12.9), (std::vector<double>{10.5, 11, 11.5, 12, 12.5}))
        << "no digit would be in view";
}

TEST(FigureSpec, categoriesMayHoldQuotes) {
    Figure figure = withLayers({Bars{"", {groupedBar(0, 0, 2, 1), groupedBar(0, 1, 2, 2)}}});
    figure.panels[0].x.categories = {"the \"new\" one", "it's"};
    const json axis = markNamed(figureSpec(figure), "panel_0").at("axes")[0];
    EXPECT_EQ(axis["encode"]["labels"]["update"]["text"]["signal"],
              R"(["the \"new\" one","it's"][datum.value])");
}

TEST(FigureSpec, panelsFillRowsAndTheFigureHoldsThem) {
    Figure figure = withLayers({});
    figure.columns = 2;
    figure.panels.resize(3);
    const json spec = figureSpec(figure);
    const json a = markNamed(spec, "panel_0"), b = markNamed(spec, "panel_1"), c = markNamed(spec, "panel_2");
    EXPECT_EQ(number(a, "y"), number(b, "y"));
    EXPECT_LT(number(a, "x") + number(a, "width"), number(b, "x"));
    EXPECT_LE(number(b, "x") + number(b, "width"), spec["width"].get<double>());
    EXPECT_GT(number(c, "y"), number(a, "y") + number(a, "height"));
    EXPECT_LE(number(c, "y") + number(c, "height"), spec["height"].get<double>());
}

TEST(FigureParts, groupedBarsLieSideBySideAroundTheirCategory) {
    const Bar left = groupedBar(2, 0, 2, 1), right = groupedBar(2, 1, 2, 1);
    EXPECT_NEAR(left.from, 1.6, 1e-12);  // a group is 0.8 wide: 1.6 to 2.4
    EXPECT_NEAR(left.to, 2.0, 1e-12);
    EXPECT_NEAR(right.from, 2.0, 1e-12);
    EXPECT_NEAR(right.to, 2.4, 1e-12);
}

TEST(FigureParts, histogramOutlineAndBand) {
    EXPECT_EQ(histogramOutline({0, 1, 3}, {4, 5}), (Points2{{0, 0}, {0, 4}, {1, 4}, {1, 5}, {3, 5}, {3, 0}}));
    EXPECT_THROW(histogramOutline({0, 1}, {4, 5}), std::invalid_argument);
    EXPECT_EQ(sigmaBand({1}, {0.5})[0].low, -1.5);
    EXPECT_EQ(sigmaBand({1}, {0.5})[0].high, 1.5);
    EXPECT_THROW(series({1, 2}, {1}), std::invalid_argument);
}

}  // namespace figure_spec_test
}  // namespace slamot::report

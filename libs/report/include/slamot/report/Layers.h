#pragma once
// What a panel is made of. Coordinates are in the units of the panel's axes. A value that is not finite (on a
// logarithmic axis also one that is not positive) is a gap in lines and bands and is left out everywhere
// else. A layer with a label has an entry in the legend; an empty label has none.
#include <Eigen/Core>
#include <string>
#include <variant>
#include <vector>

#include "slamot/report/Palette.h"

namespace slamot::report {

using Points2 = std::vector<Eigen::Vector2d>;

/// Pairs the values of two columns; throws std::invalid_argument when their lengths differ.
Points2 series(const std::vector<double>& x, const std::vector<double>& y);

/// Straight pieces through the points in their order.
struct Line {
    std::string label;
    Points2 points;
    std::string colour = colour::blue;
    double width = 1.5;  ///< pixels
    Dash dash = Dash::solid;
    double opacity = 1;
};

/// The outline of a histogram, for a Line: `counts` has one entry fewer than `edges`.
Points2 histogramOutline(const std::vector<double>& edges, const std::vector<double>& counts);

/// `times` and `plus` are thin strokes, the others are filled.
enum class Symbol { dot, square, triangle, times, plus, ring };

struct Points {
    std::string label;
    Points2 points;
    std::string colour = colour::black;
    Symbol symbol = Symbol::dot;
    double size = 5;  ///< diameter, pixels
    double opacity = 1;
    bool outlined = false;  ///< a white rim, for the few marks that must stand out from data beneath them
};

struct BandRow {
    double x = 0, low = 0, high = 0;
};

/// The area between two curves.
struct Band {
    std::string label;
    std::vector<BandRow> rows;
    std::string colour = colour::sky;
    double opacity = 0.3;
};

/// -k sigma to +k sigma around zero, the companion of an error line.
std::vector<BandRow> sigmaBand(const std::vector<double>& x, const std::vector<double>& sigma, double k = 3);

struct GaussianPoint {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

/// Outlines at a Mahalanobis distance of k.
struct Ellipses {
    std::string label;
    std::vector<GaussianPoint> gaussians;
    double k = 3;
    std::string colour = colour::black;
    double width = 0.8;  ///< pixels
    double opacity = 0.6;
};

struct Bar {
    double from = 0, to = 0, value = 0;
};

/// Upright bars from `base` (on a logarithmic axis: from the bottom) to their values.
struct Bars {
    std::string label;
    std::vector<Bar> bars;
    double base = 0;
    std::string colour = colour::blue;
    double opacity = 1;
};

/// The bar of one series in a category's group: categories lie at 0, 1, 2, ... (Axis::categories).
Bar groupedBar(std::size_t category, std::size_t series, std::size_t series_count, double value);

/// A line across the whole panel at a value of y (horizontal) or x (upright).
struct Rule {
    std::string label;
    double value = 0;
    bool upright = false;
    std::string colour = colour::grey;
    Dash dash = Dash::dashed;
    double width = 1.2;  ///< pixels
};

struct TextAt {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    std::string text;
};

/// Words beside points: above and to the right, moved by `offset` (pixels, right and up).
struct Texts {
    std::vector<TextAt> texts;
    std::string colour = colour::text;
    Eigen::Vector2d offset{5, 5};
};

enum class ColourMap {
    viridis,    ///< a quantity from little to much
    grey,       ///< occupancy: free white, occupied black
    diverging,  ///< a signed quantity about the middle of its range, e.g. correlation
};

/// A matrix of cells over [x_min, x_max] x [y_min, y_max]; row 0 of `values` lies at y_min, column 0 at
/// x_min. Values outside [low, high] take the end colours; cells that are not finite stay empty. Linear axes
/// only.
struct HeatMap {
    std::string label;  ///< with the unit; stands beside the colour bar
    Eigen::MatrixXd values;
    double x_min = 0, x_max = 1, y_min = 0, y_max = 1;
    double low = 0, high = 1;
    ColourMap colours = ColourMap::viridis;
};

using Layer = std::variant<HeatMap, Band, Bars, Ellipses, Line, Points, Rule, Texts>;

}  // namespace slamot::report

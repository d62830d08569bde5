#pragma once
// Okabe and Ito's colours, told apart with the common forms of colour blindness and in grey print, and the
// greys of everything that is not data (M. Okabe, K. Ito, Color Universal Design, 2008).
#include <cstddef>
#include <map>
#include <string>

namespace slamot::report {

namespace colour {
inline constexpr const char* blue = "#0072B2";
inline constexpr const char* vermillion = "#D55E00";
inline constexpr const char* green = "#009E73";
inline constexpr const char* orange = "#E69F00";
inline constexpr const char* purple = "#CC79A7";
inline constexpr const char* sky = "#56B4E9";
inline constexpr const char* black = "#000000";
inline constexpr const char* text = "#222222";
inline constexpr const char* grey = "#6E6E6E";
inline constexpr const char* pale_grey = "#A0A0A0";
inline constexpr const char* frame = "#B8B8B8";
inline constexpr const char* grid = "#E9E9E9";
}  // namespace colour

/// The colours that change on a dark background, and into which; the others are seen on both.
std::map<std::string, std::string> darkColours();

enum class Dash { solid, dashed, dotted };

/// How one of several series is drawn: after six colours the dash pattern changes, so that eighteen differ.
struct SeriesStyle {
    std::string colour;
    Dash dash = Dash::solid;
};

SeriesStyle seriesStyle(std::size_t index);

}  // namespace slamot::report

#include "slamot/report/Palette.h"

#include <array>

namespace slamot::report {

SeriesStyle seriesStyle(std::size_t index) {
    // Okabe and Ito's yellow is left out: too pale on white.
    static constexpr std::array colours = {colour::vermillion, colour::green, colour::purple,
                                           colour::orange,     colour::sky,   colour::blue};
    static constexpr std::array dashes = {Dash::solid, Dash::dashed, Dash::dotted};
    return {colours[index % colours.size()], dashes[index / colours.size() % dashes.size()]};
}

std::map<std::string, std::string> darkColours() {
    return {{"white", "#15181C"},      {colour::black, "#F0F0F0"},     {colour::text, "#E8E8E8"},
            {colour::grey, "#A8ADB5"}, {colour::pale_grey, "#7D838C"}, {colour::frame, "#4A505A"},
            {colour::grid, "#2A2F36"}, {colour::blue, "#3A9AD9"}};
}

}  // namespace slamot::report

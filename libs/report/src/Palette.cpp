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

}  // namespace slamot::report

#include "ColourMap.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace slamot::report {
namespace {

using Rgb = std::array<double, 3>;

/// Evenly spaced support colours. Viridis: S. van der Walt, N. Smith, matplotlib; diverging: C. Brewer's
/// RdBu, reversed, both readable with the common forms of colour blindness.
const std::vector<Rgb>& anchors(ColourMap colours) {
    static const std::vector<Rgb> viridis = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                             {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                             {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
    static const std::vector<Rgb> grey = {{255, 255, 255}, {0, 0, 0}};
    static const std::vector<Rgb> diverging = {{5, 48, 97},     {67, 147, 195},  {209, 229, 240},
                                               {247, 247, 247}, {253, 219, 199}, {214, 96, 77},
                                               {103, 0, 31}};
    switch (colours) {
        case ColourMap::grey:
            return grey;
        case ColourMap::diverging:
            return diverging;
        case ColourMap::viridis:
            break;
    }
    return viridis;
}

Rgb colourAt(const std::vector<Rgb>& support, double fraction) {
    const double place = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(support.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), support.size() - 2);
    const double weight = place - static_cast<double>(below);
    Rgb rgb{};
    for (std::size_t c = 0; c < rgb.size(); ++c) {
        rgb[c] = (1 - weight) * support[below][c] + weight * support[below + 1][c];
    }
    return rgb;
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
    std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // EVP_EncodeBlock ends with a zero
    const int size = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                                     static_cast<int>(bytes.size()));
    text.resize(static_cast<std::size_t>(size));
    return text;
}

std::vector<std::uint8_t> encodePng(const std::vector<std::uint8_t>& rgba, std::size_t width,
                                    std::size_t height) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.format = PNG_FORMAT_RGBA;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<std::uint8_t> bytes(size);
    if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, rgba.data(), 0, nullptr)) {
        throw std::runtime_error(
            fmt::format("a heat map of {} x {} cells: {}", width, height, image.message));
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace

std::string heatMapImage(const HeatMap& map) {
    const Eigen::Index rows = map.values.rows(), columns = map.values.cols();
    if (rows == 0 || columns == 0) {
        throw std::invalid_argument("a heat map has no cells; expected at least one");
    }
    // Viewers blur an image when they enlarge it, so the cells are enlarged here.
    constexpr Eigen::Index enough = 1200;  // pixels
    const Eigen::Index zoom = std::max<Eigen::Index>(1, enough / std::max(rows, columns));
    std::vector<std::uint8_t> rgba;
    rgba.reserve(static_cast<std::size_t>(4 * rows * columns * zoom * zoom));
    for (Eigen::Index r = rows * zoom - 1; r >= 0; --r) {
        for (Eigen::Index c = 0; c < columns * zoom; ++c) {
            const double value = map.values(r / zoom, c / zoom);
            const bool known = std::isfinite(value);
            const double fraction = known ? (value - map.low) / (map.high - map.low) : 0;
            for (const double channel : colourAt(anchors(map.colours), fraction)) {
                rgba.push_back(static_cast<std::uint8_t>(std::lround(channel)));
            }
            rgba.push_back(known ? 255 : 0);
        }
    }
    return "data:image/png;base64," + base64(encodePng(rgba, static_cast<std::size_t>(columns * zoom),
                                                       static_cast<std::size_t>(rows * zoom)));
}

nlohmann::json colourGradient(ColourMap colours) {
    const std::vector<Rgb>& support = anchors(colours);
    nlohmann::json stops = nlohmann::json::array();
    for (std::size_t i = 0; i < support.size(); ++i) {
        const Rgb& c = support[i];
        stops.push_back({{"offset", static_cast<double>(i) / static_cast<double>(support.size() - 1)},
                         {"color", fmt::format("rgb({:.0f},{:.0f},{:.0f})", c[0], c[1], c[2])}});
    }
    return {{"gradient", "linear"}, {"x1", 0}, {"y1", 1}, {"x2", 0}, {"y2", 0}, {"stops", stops}};
}

}  // namespace slamot::report

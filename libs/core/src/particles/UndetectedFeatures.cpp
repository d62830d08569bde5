#include "slamot/core/particles/UndetectedFeatures.h"

#include <cmath>

namespace slamot {

int UndetectedFeatures::cellOf(double coordinate) {
    return static_cast<int>(std::floor(coordinate / cell));
}

std::size_t UndetectedFeatures::place(int x, int y) const {
    const auto found = std::lower_bound(tiles_.begin(), tiles_.end(), std::pair(y, x),
                                        [](const Placed& a, const auto& b) { return std::pair(a.y, a.x) < b; });
    return static_cast<std::size_t>(found - tiles_.begin());
}

std::size_t UndetectedFeatures::tileAt(int x, int y) {
    const std::size_t number = place(x, y);
    if (number < tiles_.size() && tiles_[number].x == x && tiles_[number].y == y) return number;
    auto tile = std::make_shared<Tile>();
    tile->owner = owner_;
    tile->part.fill(1);
    tiles_.insert(tiles_.begin() + static_cast<std::ptrdiff_t>(number), {x, y, std::move(tile)});
    return number;
}

double UndetectedFeatures::part(const Vector2& point) const {
    const int x = cellOf(point.x()), y = cellOf(point.y()), tile_x = tileOf(x), tile_y = tileOf(y);
    const std::size_t number = place(tile_x, tile_y);
    if (number == tiles_.size() || tiles_[number].x != tile_x || tiles_[number].y != tile_y) return 1;
    return tiles_[number].tile->part[static_cast<std::size_t>((y - tile_y * side) * side + x - tile_x * side)];
}

}  // namespace slamot

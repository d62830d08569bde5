#pragma once
// The features that no scan has shown yet, as a Poisson process: its intensity falls wherever a sensor looks and sees
// nothing. Kept on a grid of square cells, in tiles that particles share until one of them writes.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "slamot/core/data/Pose2.h"

namespace slamot {

class UndetectedFeatures {
  public:
    static constexpr double cell = 2.5;  ///< [m]
    using Owner = std::uint64_t;

    /// Tiles made from now on belong to `owner`, those made before to nobody.
    void renew(Owner owner) { owner_ = owner; }

    /// Part of the features about a point that is not detected yet: 1 where no sensor has looked.
    double part(const Vector2& point) const;

    /// A look: missed(centre) is the probability that a feature in the cell about that centre is not detected. Cells
    /// whose centre is at most `radius` [m] from `middle` are asked for, unless next to nothing is left there. Returns
    /// the area [m^2] of undetected ground that turns up in this look: the sum of part times 1 - missed.
    template <class Missed>
    double look(const Vector2& middle, double radius, const Missed& missed) {
        double found = 0;
        const int first_x = cellOf(middle.x() - radius), last_x = cellOf(middle.x() + radius);
        const int first_y = cellOf(middle.y() - radius), last_y = cellOf(middle.y() + radius);
        for (int tile_y = tileOf(first_y); tile_y <= tileOf(last_y); ++tile_y) {
            for (int tile_x = tileOf(first_x); tile_x <= tileOf(last_x); ++tile_x) {
                const std::size_t number = tileAt(tile_x, tile_y);
                const int x0 = tile_x * side, y0 = tile_y * side;
                for (int y = std::max(first_y, y0); y <= std::min(last_y, y0 + side - 1); ++y) {
                    for (int x = std::max(first_x, x0); x <= std::min(last_x, x0 + side - 1); ++x) {
                        const std::size_t i = static_cast<std::size_t>((y - y0) * side + x - x0);
                        const float before = tiles_[number].tile->part[i];
                        if (before <= least) continue;
                        const Vector2 centre((x + 0.5) * cell, (y + 0.5) * cell);
                        if ((centre - middle).squaredNorm() > radius * radius) continue;
                        const double m = missed(centre);
                        if (m >= 1) continue;
                        found += before * (1 - m);
                        own(number).part[i] = static_cast<float>(before * m);
                    }
                }
            }
        }
        return found * cell * cell;
    }

  private:
    static constexpr int side = 16;  ///< of a tile [cells]
    static constexpr float least = 1e-6f;

    struct Tile {
        Owner owner;
        std::array<float, side * side> part;
    };
    struct Placed {
        int x, y;
        std::shared_ptr<Tile> tile;
    };

    static int cellOf(double coordinate);
    static int tileOf(int cell_number) {
        return cell_number >= 0 ? cell_number / side : -((side - 1 - cell_number) / side);
    }
    /// Where the tile is among tiles_, or belongs.
    std::size_t place(int x, int y) const;
    /// Makes the tile if it is not there.
    std::size_t tileAt(int x, int y);
    Tile& own(std::size_t number) {
        auto& tile = tiles_[number].tile;
        if (tile->owner != owner_) {
            tile = std::make_shared<Tile>(*tile);
            tile->owner = owner_;
        }
        return *tile;
    }

    Owner owner_ = 0;
    std::vector<Placed> tiles_;  ///< by y, then x
};

}  // namespace slamot

#pragma once
// Which landmarks are near: finds them without looking at the map.
#include <memory>
#include <unordered_map>
#include <vector>

#include "slamot/core/data/Detections.h"
#include "slamot/core/estimation/Blocks.h"

namespace slamot {

/// Positions of blocks in an R-tree. A landmark that moves stays where it is in the tree until it has gone
/// further than `slack`; queries look that much further and then compare the positions they were told, so
/// that results are exact and filters may tell every small correction. All results ascend by id.
class LandmarkIndex {
  public:
    /// [m]
    explicit LandmarkIndex(double slack = 0.5);
    ~LandmarkIndex();
    LandmarkIndex(LandmarkIndex&&) noexcept;
    LandmarkIndex& operator=(LandmarkIndex&&) noexcept;

    int size() const { return static_cast<int>(places_.size()); }
    /// Adds a landmark or moves it. Throws std::invalid_argument for a position that is not finite.
    void set(BlockId landmark, const Vector2& position);
    /// Throws std::out_of_range for one that is not there.
    void remove(BlockId landmark);

    /// At most `radius` [m] from `centre`.
    std::vector<BlockId> within(const Vector2& centre, double radius) const;

    /// All that `sensor` may see from `robot`: within its range and field of view, both widened by how far
    /// the pose lies off with `probability` for each of position and heading, and by `margin` [m] for the
    /// landmarks' own errors. Throws std::invalid_argument for a sensor whose max_range is not known.
    std::vector<BlockId> inView(const PoseGaussian& robot, const RangeBearingSensor& sensor,
                                double probability, double margin) const;

  private:
    struct Place {
        Vector2 told, in_tree;
    };
    template <class Keep>
    std::vector<BlockId> search(const Vector2& centre, double radius, const Keep& keep) const;

    class Tree;
    double slack_;
    std::unordered_map<BlockId, Place> places_;
    std::unique_ptr<Tree> tree_;
};

}  // namespace slamot

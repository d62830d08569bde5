#pragma once
// Where blocks stand in a vector of coordinates.
#include <utility>
#include <vector>

#include "slamot/core/estimation/Blocks.h"

namespace slamot {

struct BlockPlace {
    BlockId id;
    BlockKind kind;
    int offset, size;
    /// Leading 2-vectors that turn with the world.
    int turning;
    bool put_away = false;
};

/// The 2-vectors of a block that turn with the world, as a count from its start.
int turningVectors(BlockKind kind);

/// Blocks without gaps, in the order they were added. Removed blocks leave nothing behind.
class BlockLayout {
  public:
    int dimension() const { return dimension_; }
    /// In the order of their offsets.
    const std::vector<BlockPlace>& places() const { return places_; }
    /// Those of a kind, in the same order.
    std::vector<BlockId> blocks(BlockKind kind) const;
    bool contains(BlockId id) const { return find(id) >= 0; }
    /// Throws std::out_of_range for a block that is not there.
    const BlockPlace& at(BlockId id) const;

    void append(BlockId id, BlockKind kind, int size) { append(id, kind, size, turningVectors(kind)); }
    void append(BlockId id, BlockKind kind, int size, int turning);
    void remove(BlockId id);
    void setPutAway(BlockId id, bool away);
    void clear();

  private:
    int find(BlockId id) const;

    std::vector<BlockPlace> places_;
    std::vector<std::pair<BlockId, int>> index_;  ///< (id, position in places_), by id
    int dimension_ = 0;
};

}  // namespace slamot

#include "slamot/core/estimation/BlockLayout.h"

#include <algorithm>
#include <stdexcept>

namespace slamot {

int turningVectors(BlockKind kind) {
    switch (kind) {
        case BlockKind::robot:
        case BlockKind::pose:
            return 1;
        case BlockKind::target:
            return 3;
        case BlockKind::landmark:
            return 1;
        case BlockKind::extra:
            return 0;
    }
    return 0;
}

int BlockLayout::find(BlockId id) const {
    const auto found = std::lower_bound(index_.begin(), index_.end(), std::pair<BlockId, int>{id, 0});
    return found != index_.end() && found->first == id ? found->second : -1;
}

const BlockPlace& BlockLayout::at(BlockId id) const {
    const int position = find(id);
    if (position < 0) throw std::out_of_range("no such block in the joint state");
    return places_[static_cast<std::size_t>(position)];
}

void BlockLayout::append(BlockId id, BlockKind kind, int size, int turning) {
    const std::pair<BlockId, int> entry{id, static_cast<int>(places_.size())};
    index_.insert(std::lower_bound(index_.begin(), index_.end(), entry), entry);
    places_.push_back({id, kind, dimension_, size, turning});
    dimension_ += size;
}

void BlockLayout::remove(BlockId id) {
    const BlockPlace gone = at(id);
    const int position = find(id);
    places_.erase(places_.begin() + position);
    for (auto place = places_.begin() + position; place != places_.end(); ++place) place->offset -= gone.size;
    index_.erase(std::lower_bound(index_.begin(), index_.end(), std::pair<BlockId, int>{id, 0}));
    for (auto& [other, at] : index_)
        if (at > position) --at;
    dimension_ -= gone.size;
}

void BlockLayout::setPutAway(BlockId id, bool away) {
    at(id);
    places_[static_cast<std::size_t>(find(id))].put_away = away;
}

void BlockLayout::clear() {
    places_.clear();
    index_.clear();
    dimension_ = 0;
}

std::vector<BlockId> BlockLayout::blocks(BlockKind kind) const {
    std::vector<BlockId> out;
    for (const BlockPlace& place : places_)
        if (place.kind == kind) out.push_back(place.id);
    return out;
}

}  // namespace slamot

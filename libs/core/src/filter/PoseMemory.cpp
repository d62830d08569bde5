#include "slamot/core/filter/PoseMemory.h"

#include <algorithm>

namespace slamot {
namespace {

/// Scans: objects that take longer to confirm lose their first sights. Each costs three dimensions.
constexpr std::size_t most_poses = 6;

}  // namespace

void PoseMemory::remember(ModalState& belief, Stamp now) {
    if (poses_.size() < most_poses) {
        poses_.push_back({belief.rememberPose(), now});
        return;
    }
    Remembered& oldest = *std::min_element(poses_.begin(), poses_.end(),
                                           [](const auto& a, const auto& b) { return a.at < b.at; });
    belief.rememberPose(oldest.block);
    oldest.at = now;
}

std::optional<BlockId> PoseMemory::at(Stamp scan) const {
    const auto found =
        std::find_if(poses_.begin(), poses_.end(), [&](const Remembered& r) { return r.at == scan; });
    return found == poses_.end() ? std::nullopt : std::optional(found->block);
}

}  // namespace slamot

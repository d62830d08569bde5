#pragma once
// Where the robot was at its latest scans, as part of the joint state: what was seen then can be taken in
// when it is known to have been an object, with all its correlations.
#include "slamot/core/estimation/ModalState.h"

namespace slamot {

class PoseMemory {
  public:
    void clear() { poses_.clear(); }
    /// The present pose; it takes the place of the oldest when there are enough.
    void remember(ModalState& belief, Stamp now);
    /// Of a scan at that time; none where it is forgotten.
    std::optional<BlockId> at(Stamp scan) const;

  private:
    struct Remembered {
        BlockId block;
        Stamp at;
    };
    std::vector<Remembered> poses_;
};

}  // namespace slamot

#pragma once
// Two landmarks that may be one: evidence from what is seen of both. Landmarks that are one are never both
// detected in a scan; two that are close to one another are, as often as P_D^2.
#include <map>
#include <utility>
#include <vector>

#include "slamot/core/estimation/Blocks.h"

namespace slamot {

/// Sequential test of each watched pair: the log of how much likelier its looks are if it is one landmark.
///
///   detected   if one                                    if two           adds
///   one        P_D                                       2 P_D (1 - P_D)  -log(2 (1 - P_D))
///   none       1 - P_D                                   (1 - P_D)^2      -log(1 - P_D)
///   both       P_D, and clutter where the other stands   P_D^2            log(1e-3)
///
/// Up to P_D = 1/2 two landmarks show one of them at least as often as one landmark shows itself: such a look
/// speaks of two then, and is not held at 0 or above, or pairs that are two would be merged in time. Over all
/// outcomes the evidence still grows for what is one; it does so by the looks that show none.
class DuplicateWatch {
  public:
    /// merge_probability: of being one, at which a pair is reported, from even odds at the start. Both lie
    /// within (0, 1); throws std::invalid_argument otherwise.
    DuplicateWatch(double detection_probability, double merge_probability);

    /// One look at a pair that is compatible with being one, both surely in view. Misses count as
    /// independent: what hides one landmark hides its neighbour too, so a look that shows none is to be
    /// handed in only where nothing can hide them.
    void look(BlockId a, BlockId b, bool a_detected, bool b_detected);
    /// Something showed that they are two, or are not where they seemed to be: the evidence is void.
    void forget(BlockId a, BlockId b);
    /// A landmark that is there no more.
    void forget(BlockId landmark);

    /// Pairs that are one, older block first, ascending; each is reported until it is forgotten. A landmark
    /// may be in several: after merging a pair, forget its younger block and ask again.
    std::vector<std::pair<BlockId, BlockId>> merged() const;

  private:
    double one_detected_, none_detected_, decision_;
    std::map<std::pair<BlockId, BlockId>, double> evidence_;
};

}  // namespace slamot

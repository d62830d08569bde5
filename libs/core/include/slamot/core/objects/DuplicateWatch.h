#pragma once
// Two landmarks that may be one: evidence from what is seen of both. Landmarks that are one are never both
// detected in a scan; two that are close to one another are, as often as P_D^2.
#include <map>
#include <utility>
#include <vector>

#include "slamot/core/estimation/Blocks.h"

namespace slamot {

/// Sequential test of each watched pair: the log of how much likelier its looks are if it is one landmark.
class DuplicateWatch {
  public:
    /// merge_probability: of being one, at which a pair is reported, from even odds at the start.
    DuplicateWatch(double detection_probability, double merge_probability);

    /// One look at a pair that is compatible with being one, both surely in view.
    void look(BlockId a, BlockId b, bool a_detected, bool b_detected);
    /// Something showed that they are two, or are not where they seemed to be: the evidence is void.
    void forget(BlockId a, BlockId b);
    /// A landmark that is there no more.
    void forget(BlockId landmark);

    /// Pairs that are one, older block first; each is reported until it is forgotten.
    std::vector<std::pair<BlockId, BlockId>> merged() const;

  private:
    double one_detected_, both_detected_, decision_;
    std::map<std::pair<BlockId, BlockId>, double> evidence_;
};

}  // namespace slamot

#pragma once
// Matchings of one stamp by what they save: the best, and all that save nearly as much.
#include <cstddef>
#include <vector>

namespace slamot::eval {

/// A pair of objects by their places in a list, and what assigning it saves.
struct PlacedGain {
    std::size_t target, track;
    double saved;
};

/// Pairs that share no object, or the choice of pairs they are made from.
using PairSet = std::vector<PlacedGain>;

double sumOf(const PairSet& pairs);

/// The matching that saves most; `objects` is the length of the list.
PairSet bestMatching(const PairSet& pairs, std::size_t objects);

/// The matchings that save less than `best` by no more than `gap`; nothing if more than `most` of them, or 16
/// times as many beginnings of some, had to be looked at.
std::vector<PairSet> matchingsWithin(double gap, const PairSet& pairs, const PairSet& best,
                                     std::size_t objects, std::size_t most);

}  // namespace slamot::eval

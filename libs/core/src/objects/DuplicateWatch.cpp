#include "slamot/core/objects/DuplicateWatch.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace slamot {
namespace {

/// Both detected although they are one: the expected number of clutter within the other's gate, over P_D. A
/// bound; at 5 false detections in 30 m x 180 degrees a gate of 1 m x 2 degrees holds 2e-3 of them.
const double both_detected = std::log(1e-3);

/// Blocks are numbered in the order in which they came.
std::pair<BlockId, BlockId> olderFirst(BlockId a, BlockId b) {
    return std::minmax({a, b});
}

void checkProbability(double p, const char* name) {
    if (!(p > 0 && p < 1))
        throw std::invalid_argument("DuplicateWatch: " + std::string(name) + " " + std::to_string(p) +
                                    ", expected one within (0, 1)");
}

}  // namespace

DuplicateWatch::DuplicateWatch(double detection_probability, double merge_probability) {
    checkProbability(detection_probability, "detection probability");
    checkProbability(merge_probability, "merge probability");
    one_detected_ = -std::log(2 * (1 - detection_probability));
    none_detected_ = -std::log1p(-detection_probability);
    decision_ = std::log(merge_probability) - std::log1p(-merge_probability);
}

void DuplicateWatch::look(BlockId a, BlockId b, bool a_detected, bool b_detected) {
    evidence_[olderFirst(a, b)] += a_detected && b_detected   ? both_detected
                                   : a_detected || b_detected ? one_detected_
                                                              : none_detected_;
}

void DuplicateWatch::forget(BlockId a, BlockId b) {
    evidence_.erase(olderFirst(a, b));
}

void DuplicateWatch::forget(BlockId landmark) {
    for (auto pair = evidence_.begin(); pair != evidence_.end();) {
        const auto& [older, younger] = pair->first;
        pair = older == landmark || younger == landmark ? evidence_.erase(pair) : std::next(pair);
    }
}

std::vector<std::pair<BlockId, BlockId>> DuplicateWatch::merged() const {
    std::vector<std::pair<BlockId, BlockId>> out;
    for (const auto& [pair, evidence] : evidence_)
        if (evidence >= decision_) out.push_back(pair);
    return out;
}

}  // namespace slamot

#pragma once
#include <string>
#include <vector>

#include "slamot/rawlog/Sha256.h"

namespace slamot::study {

/// SHA-256 of several texts, none of which can pass for a part of another.
inline std::string digestOf(const std::vector<std::string>& texts) {
    Sha256 sum;
    for (const std::string& text : texts) {
        const std::string length = std::to_string(text.size()) + ":";
        sum.add(length.data(), length.size());
        sum.add(text.data(), text.size());
    }
    return sum.hex();
}

/// The first 64 bits of a digest.
inline std::uint64_t bitsOf(const std::string& digest) {
    return std::stoull(digest.substr(0, 16), nullptr, 16);
}

}  // namespace slamot::study

#include "slamot/core/random/RandomStream.h"

#include <Random123/philox.h>

#include <cmath>
#include <stdexcept>

#include "slamot/core/data/Angle.h"

namespace slamot {
namespace {

constexpr int robot_bits = 20;

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint32_t robot, std::uint32_t step,
                           std::uint32_t index)
    : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
      // The first counter word counts blocks; the rest say whose draws these are.
      counter_{0, index, step, (static_cast<std::uint32_t>(purpose) << robot_bits) | robot},
      block_{} {
    if (robot >> robot_bits) throw std::invalid_argument("random streams number robots (or movers) below 2^20");
}

std::uint32_t RandomStream::bits() {
    if (next_ == 4) {
        const r123::Philox4x32 philox;
        const r123::Philox4x32::ctr_type counter{{counter_[0], counter_[1], counter_[2], counter_[3]}};
        const r123::Philox4x32::key_type key{{key_[0], key_[1]}};
        const auto out = philox(counter, key);
        for (int i = 0; i < 4; ++i) block_[i] = out[i];
        ++counter_[0];
        next_ = 0;
    }
    return block_[next_++];
}

double RandomStream::uniform() {
    const std::uint64_t high = bits(), low = bits();
    const std::uint64_t mantissa = ((high << 32) | low) >> 11;
    return (static_cast<double>(mantissa) + 0.5) * 0x1.0p-53;
}

double RandomStream::normal() {
    if (has_spare_) {
        has_spare_ = false;
        return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(uniform())), angle = 2.0 * pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
}

int RandomStream::poisson(double mean) {
    const double floor = std::exp(-mean);
    int count = 0;
    for (double product = uniform(); product > floor; product *= uniform()) ++count;
    return count;
}

std::uint64_t derivedSeed(std::uint64_t seed, std::uint64_t number) {
    const r123::Philox4x32 philox;
    const r123::Philox4x32::ctr_type counter{{static_cast<std::uint32_t>(number),
                                              static_cast<std::uint32_t>(number >> 32), 0x736c616du, 0x6f740000u}};
    const r123::Philox4x32::key_type key{{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
    const auto out = philox(counter, key);
    return (static_cast<std::uint64_t>(out[0]) << 32) | out[1];
}

}  // namespace slamot

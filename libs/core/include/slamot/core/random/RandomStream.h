#pragma once
// Random numbers as a function of who asks for what: no state is shared, so any number of threads and any order
// of calls give the same draws.
#include <array>
#include <cstdint>

namespace slamot {

/// What a draw is for. Part of its key: two purposes never share numbers. Append only.
enum class RandomPurpose : std::uint32_t {
    test = 0,
    world,
    mover,
    control,
    range_bearing,
    detection,
    clutter,
    resampling,
    proposal,
    added_clutter,
    withheld_detection,
};

/// An endless stream of draws keyed by (seed, purpose, robot, step, index), by Philox 4x32-10.
class RandomStream {
   public:
    RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint32_t robot = 0, std::uint32_t step = 0,
                 std::uint32_t index = 0);

    std::uint32_t bits();
    /// Uniform in the open interval (0, 1), 53 bits.
    double uniform();
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Standard normal by Box-Muller, both values used.
    double normal();
    double normal(double mean, double deviation) { return mean + deviation * normal(); }
    /// By inversion; mean below 500.
    int poisson(double mean);

   private:
    std::array<std::uint32_t, 2> key_;
    std::array<std::uint32_t, 4> counter_, block_;
    int next_ = 4;
    bool has_spare_ = false;
    double spare_ = 0;
};

/// A 64-bit seed made from another and a number: for worlds, replicates, robots.
std::uint64_t derivedSeed(std::uint64_t seed, std::uint64_t number);

}  // namespace slamot

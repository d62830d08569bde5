#include <gtest/gtest.h>

#include <bitset>
#include <cmath>
#include <set>
#include <vector>

#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace random_stream_test {

constexpr auto test_purpose = RandomPurpose::test;

TEST(RandomStreamTest, IsPhilox) {
    // Random123's published known answer for philox4x32-10: counter 0, key 0.
    RandomStream stream(0, test_purpose);
    for (const std::uint32_t expected : {0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u})
        EXPECT_EQ(stream.bits(), expected);
}

std::vector<std::uint32_t> firstDraws(RandomStream stream, int count = 8) {
    std::vector<std::uint32_t> draws;
    for (int i = 0; i < count; ++i) draws.push_back(stream.bits());
    return draws;
}

TEST(RandomStreamTest, DoesNotDependOnTheOrderOfCalls) {
    RandomStream a(7, test_purpose, 1, 2, 3), b(7, test_purpose, 1, 2, 4);
    std::vector<std::uint32_t> from_a, from_b;
    for (int i = 0; i < 20; ++i) {
        from_b.push_back(b.bits());
        if (i % 3 == 0) b.normal();  // b runs ahead; a does not notice
        from_a.push_back(a.bits());
    }
    EXPECT_EQ(from_a, firstDraws(RandomStream(7, test_purpose, 1, 2, 3), 20));
    EXPECT_NE(from_a, from_b);
}

TEST(RandomStreamTest, KeysNeverShareDraws) {
    // Distinct counters give distinct 128-bit blocks, since Philox is a bijection of them.
    std::set<std::vector<std::uint32_t>> seen;
    int streams = 0;
    for (const std::uint64_t seed : {0ull, 1ull, 1ull << 32})
        for (std::uint32_t purpose = 0; purpose <= static_cast<std::uint32_t>(RandomPurpose::proposal);
             ++purpose)
            for (std::uint32_t robot = 0; robot < 4; ++robot)
                for (const std::uint32_t step : {0u, 1u, 77u})
                    for (const std::uint32_t index : {0u, 1u, 77u}) {
                        seen.insert(
                            firstDraws({seed, static_cast<RandomPurpose>(purpose), robot, step, index}, 4));
                        ++streams;
                    }
    EXPECT_EQ(static_cast<int>(seen.size()), streams);
}

TEST(RandomStreamTest, UniformLiesInTheOpenIntervalWithItsMoments) {
    // 10^6 draws: mean 1/2 with deviation sqrt(1/12)/1000 = 2.9e-4, second moment 1/3 with sqrt(4/45)/1000 =
    // 3e-4. Bounds at 5 deviations: false alarm 6e-7 each over seeds; the seed is fixed, so it holds or not
    // for good.
    RandomStream stream(3, test_purpose);
    double sum = 0, squares = 0;
    for (int i = 0; i < 1000000; ++i) {
        const double u = stream.uniform();
        ASSERT_TRUE(u > 0 && u < 1);
        sum += u;
        squares += u * u;
    }
    EXPECT_NEAR(sum / 1e6, 0.5, 5 * 2.9e-4);
    EXPECT_NEAR(squares / 1e6, 1.0 / 3, 5 * 3e-4);
    for (int i = 0; i < 1000; ++i) {
        const double u = stream.uniform(-2, 3);
        ASSERT_TRUE(u > -2 && u < 3);
    }
}

TEST(RandomStreamTest, NormalHasItsMomentsAndTails) {
    // Deviations of the sample moments of 10^6 normals: mean 1e-3, variance sqrt(2)e-3, fourth moment
    // sqrt(96)e-3; lag-one product 1e-3. Bounds at 5 deviations: false alarm 6e-7 each.
    RandomStream stream(4, test_purpose);
    double m1 = 0, m2 = 0, m3 = 0, m4 = 0, lag = 0, last = 0, beyond = 0;
    for (int i = 0; i < 1000000; ++i) {
        const double x = stream.normal();
        m1 += x, m2 += x * x, m3 += x * x * x, m4 += x * x * x * x;
        lag += x * last;
        last = x;
        beyond += std::abs(x) > 3 ? 1 : 0;
    }
    EXPECT_NEAR(m1 / 1e6, 0, 5e-3);
    EXPECT_NEAR(m2 / 1e6, 1, 5 * 1.42e-3);
    EXPECT_NEAR(m3 / 1e6, 0, 5 * 3.9e-3);  // sqrt(15)
    EXPECT_NEAR(m4 / 1e6, 3, 5 * 9.8e-3);
    EXPECT_NEAR(lag / 1e6, 0, 5e-3);
    EXPECT_NEAR(beyond, 2699.8, 5 * 51.9);  // 10^6 * 2 * Phi(-3), deviation of a count
    RandomStream a(5, test_purpose), b(5, test_purpose);
    for (int i = 0; i < 10; ++i) EXPECT_DOUBLE_EQ(a.normal(2, 3), 2 + 3 * b.normal());
}

TEST(RandomStreamTest, PoissonHasItsMoments) {
    for (const double mean : {0.1, 3.0, 40.0, 400.0}) {
        RandomStream stream(6, test_purpose, 0, 0, static_cast<std::uint32_t>(10 * mean));
        const int n = 20000;
        double sum = 0, squares = 0;
        for (int i = 0; i < n; ++i) {
            const double x = stream.poisson(mean);
            sum += x;
            squares += (x - mean) * (x - mean);
        }
        // Deviation of the mean sqrt(mean/n); of the variance sqrt((mean + 2 mean^2)/n). 5 of them: 6e-7.
        EXPECT_NEAR(sum / n, mean, 5 * std::sqrt(mean / n));
        EXPECT_NEAR(squares / n, mean, 5 * std::sqrt((mean + 2 * mean * mean) / n));
    }
    RandomStream stream(6, test_purpose);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(stream.poisson(0), 0);
}

TEST(RandomStreamTest, DerivedSeedsSpread) {
    std::set<std::uint64_t> seeds;
    for (std::uint64_t seed = 0; seed < 50; ++seed)
        for (std::uint64_t number = 0; number < 50; ++number) seeds.insert(derivedSeed(seed, number));
    for (std::uint64_t number = 0; number < 50; ++number) seeds.insert(derivedSeed(0, number << 32 | 1));
    // number 1 of seed 0 is there already as (0 << 32 | 1)
    EXPECT_EQ(seeds.size(), 2500u + 49u);
    // A change of one bit changes about half of the 64: between 12 and 52 with odds of 3e-7 outside, 128
    // times.
    for (int bit = 0; bit < 64; ++bit) {
        const auto changed = [&](std::uint64_t other) {
            return std::bitset<64>(derivedSeed(5, 9) ^ other).count();
        };
        for (const std::size_t count :
             {changed(derivedSeed(5 ^ (1ull << bit), 9)), changed(derivedSeed(5, 9 ^ (1ull << bit)))}) {
            EXPECT_GT(count, 11u) << bit;
            EXPECT_LT(count, 53u) << bit;
        }
    }
}

}  // namespace random_stream_test
}  // namespace slamot

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

#include "slamot/core/threads/Workers.h"

namespace slamot {
namespace workers_test {

class WorkerCounts : public testing::TestWithParam<int> {};

TEST_P(WorkerCounts, EachThingIsDoneOnce) {
    Workers workers(GetParam());
    for (const int count : {0, 1, 2, 7, 1000}) {
        std::vector<int> done(static_cast<std::size_t>(count), 0);
        for (int round = 1; round <= 20; ++round) {
            workers.forRanges(count, [&](int first, int last) {
                for (int i = first; i < last; ++i) done[static_cast<std::size_t>(i)] += i;
            });
            // What the job wrote is read here, between two jobs.
            for (int i = 0; i < count; ++i) ASSERT_EQ(done[static_cast<std::size_t>(i)], round * i);
        }
    }
}

TEST_P(WorkerCounts, WhatAJobThrowsComesBack) {
    Workers workers(GetParam());
    EXPECT_THROW(workers.forRanges(100,
                                   [](int first, int last) {
                                       if (first <= 50 && 50 < last) throw std::domain_error("fifty");
                                   }),
                 std::domain_error);
    int sum = 0;
    workers.forRanges(1, [&](int first, int) { sum += first + 1; });
    EXPECT_EQ(sum, 1);
}

INSTANTIATE_TEST_SUITE_P(Threads, WorkerCounts, testing::Values(0, 1, 2, 4),
                         testing::PrintToStringParamName());

}  // namespace workers_test
}  // namespace slamot

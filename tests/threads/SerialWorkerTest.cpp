#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "slamot/core/estimation/SerialWorker.h"

namespace slamot {
namespace serial_worker_test {

class SerialWorkers : public testing::TestWithParam<bool> {};

TEST_P(SerialWorkers, JobsAreDoneInTheOrderTheyWerePosted) {
    SerialWorker worker(GetParam());
    std::vector<int> done, expected(1000);
    std::iota(expected.begin(), expected.end(), 0);
    for (int i = 0; i < 1000; ++i) worker.post([&done, i] { done.push_back(i); });
    worker.wait();
    EXPECT_EQ(done, expected);
    worker.wait();
}

TEST_P(SerialWorkers, AJobThatWasWaitedForIsDone) {
    SerialWorker worker(GetParam());
    worker.wait();
    int sum = 0;
    for (int i = 1; i <= 200; ++i) {
        worker.wait(worker.post([&sum, i] { sum += i; }));
        EXPECT_EQ(sum, i * (i + 1) / 2);
    }
}

INSTANTIATE_TEST_SUITE_P(Both, SerialWorkers, testing::Bool(),
                         [](const auto& each) { return each.param ? "background" : "inline"; });

TEST(SerialWorkerTest, WithoutAThreadAJobIsDoneAtOnceByWhoPostsIt) {
    SerialWorker worker(false);
    std::thread::id by;
    worker.post([&by] { by = std::this_thread::get_id(); });
    EXPECT_EQ(by, std::this_thread::get_id());
    EXPECT_THROW(worker.post([] { throw std::runtime_error("of the job"); }), std::runtime_error);
}

TEST(SerialWorkerTest, InTheBackgroundPostingDoesNotWait) {
    SerialWorker worker(true);
    std::promise<void> go;
    std::thread::id by;
    const auto first = worker.post([&] {
        go.get_future().wait();
        by = std::this_thread::get_id();
    });
    std::promise<void> last;
    worker.post([&last] { last.get_future().wait(); });
    go.set_value();      // not reached if posting waited for the job
    worker.wait(first);  // nor does this wait for the one behind
    EXPECT_NE(by, std::this_thread::get_id());
    last.set_value();
    worker.wait();
}

TEST(SerialWorkerTest, WhatAJobThrowsIsThrownByWaiting) {
    SerialWorker worker(true);
    bool later = false;
    const auto before = worker.post([] {});
    const auto failing = worker.post([] { throw std::runtime_error("of the job"); });
    worker.post([&later] { later = true; });
    for (int i = 0; i < 2; ++i) {
        try {
            worker.wait(failing);
            FAIL() << "nothing was thrown";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "of the job");
        }
    }
    EXPECT_THROW(worker.wait(), std::runtime_error);
    EXPECT_THROW(worker.wait(before), std::runtime_error);
    EXPECT_FALSE(later) << "what it works on may be in any state";
}

TEST(SerialWorkerTest, ItsEndWaitsForTheJobThatIsBeingDoneAndDropsTheOthers) {
    std::promise<void> begun;
    std::atomic<bool> first{false}, second{false};
    {
        SerialWorker worker(true);
        worker.post([&] {
            begun.set_value();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            first = true;
        });
        worker.post([&] { second = true; });
        begun.get_future().wait();
    }
    EXPECT_TRUE(first);
    EXPECT_FALSE(second);
}

}  // namespace serial_worker_test
}  // namespace slamot

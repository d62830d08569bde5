#pragma once
// Jobs that are done one after the other, in the order they were posted: at once, or by a thread of their
// own. What they leave is the same either way, so long as nobody else touches what they work on without
// waiting.
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace slamot {

class SerialWorker {
  public:
    /// Counts jobs; 0 is before the first.
    using Ticket = std::int64_t;

    /// `background`: on a thread, which starts with the first job.
    explicit SerialWorker(bool background) : background_(background) {}
    /// Jobs that have not begun are dropped.
    ~SerialWorker();
    SerialWorker(const SerialWorker&) = delete;
    SerialWorker& operator=(const SerialWorker&) = delete;

    bool background() const { return background_; }

    template <class Job>
    Ticket post(Job&& job) {
        if (background_) return enqueue(std::forward<Job>(job));
        job();
        return ++posted_;
    }
    /// Returns when this job and all before it are done. What a job on the thread has thrown is thrown here,
    /// by every call from then on; jobs after it are not begun.
    void wait(Ticket ticket) const;
    /// For all of them.
    void wait() const { wait(posted_); }

  private:
    Ticket enqueue(std::function<void()> job);
    void work();

    const bool background_;
    Ticket posted_ = 0;  ///< of the posting thread alone
    std::thread thread_;
    mutable std::mutex mutex_;  ///< of all that follows
    mutable std::condition_variable job_posted_, job_done_;
    std::deque<std::function<void()>> jobs_;
    Ticket done_ = 0;
    bool ending_ = false;
    std::exception_ptr failure_;
};

}  // namespace slamot

#include "slamot/core/estimation/SerialWorker.h"

namespace slamot {

SerialWorker::~SerialWorker() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        ending_ = true;
    }
    job_posted_.notify_one();
    thread_.join();
}

SerialWorker::Ticket SerialWorker::enqueue(std::function<void()> job) {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        jobs_.push_back(std::move(job));
    }
    if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
    job_posted_.notify_one();
    return ++posted_;
}

void SerialWorker::wait(Ticket ticket) const {
    if (!background_) return;
    std::unique_lock<std::mutex> lock(mutex_);
    job_done_.wait(lock, [&] { return done_ >= ticket || failure_ != nullptr; });
    if (failure_) std::rethrow_exception(failure_);
}

void SerialWorker::work() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
        job_posted_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
        if (ending_) return;
        std::function<void()> job = std::move(jobs_.front());
        jobs_.pop_front();
        lock.unlock();
        std::exception_ptr failure;
        try {
            job();
        } catch (...) {
            failure = std::current_exception();
        }
        job = nullptr;  // what it holds may be large, and posting must not wait for that
        lock.lock();
        ++done_;
        failure_ = failure;
        job_done_.notify_all();
        if (failure) return;
    }
}

}  // namespace slamot

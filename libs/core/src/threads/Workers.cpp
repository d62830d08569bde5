#include "slamot/core/threads/Workers.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#include "slamot/core/threads/HandOver.h"

namespace slamot {

struct Workers::Arena {
    explicit Arena(int threads) : tasks(threads) {}
    oneapi::tbb::task_arena tasks;
};

Workers::Workers(int threads)
    : threads_(std::max(threads, 1)), arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr) {}
Workers::~Workers() = default;
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;

void Workers::forRanges(int count, const std::function<void(int, int)>& job) {
    if (!arena_ || count < 2) {
        if (count > 0) job(0, count);
        return;
    }
    // A few ranges a thread: what one takes longer for, another makes up for.
    const int grain = std::max(1, count / (4 * threads_));
    const HandOver around;
    arena_->tasks.execute([&] {
        oneapi::tbb::parallel_for(
            oneapi::tbb::blocked_range<int>(0, count, static_cast<std::size_t>(grain)),
            [&](const oneapi::tbb::blocked_range<int>& range) {
                const HandOver here;
                job(range.begin(), range.end());
            },
            oneapi::tbb::simple_partitioner());
    });
}

}  // namespace slamot

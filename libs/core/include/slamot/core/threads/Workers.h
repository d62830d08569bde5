#pragma once
// Work on many things of a kind at once, each by itself: results do not depend on the number of threads.
#include <functional>
#include <memory>

namespace slamot {

/// An arena of threads (oneTBB). One job at a time, given by one thread.
class Workers {
  public:
    /// With one thread all is done by the caller.
    explicit Workers(int threads);
    ~Workers();
    Workers(Workers&&) noexcept;
    Workers& operator=(Workers&&) noexcept;

    /// Calls job(first, last) for ranges that together are [0, count), each once, in no order. The job touches
    /// nothing but what its range names. What it throws is thrown here; other ranges may have been done or not.
    void forRanges(int count, const std::function<void(int first, int last)>& job);

  private:
    struct Arena;
    int threads_;
    std::unique_ptr<Arena> arena_;
};

}  // namespace slamot

#pragma once
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace slamot {

/// Tells the thread sanitizer what it cannot see: oneTBB's library is not instrumented, so that what the
/// caller wrote before it began tasks, and what tasks wrote before they ended, would look unordered with what
/// is read later. The caller has one around the tasks, each task one before it touches anything. Tasks that
/// overlap in a run stay unordered, so races between them are found; tasks that did not overlap in this run
/// look ordered.
class HandOver {
  public:
    HandOver() { pass(); }
    ~HandOver() { pass(); }
    HandOver(const HandOver&) = delete;
    HandOver& operator=(const HandOver&) = delete;

  private:
#if defined(__SANITIZE_THREAD__)
    static inline char place_ = 0;
    static void pass() {
        __tsan_acquire(&place_);
        __tsan_release(&place_);
    }
#else
    static void pass() {}
#endif
};

}  // namespace slamot

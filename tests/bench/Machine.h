#pragma once
// What the machine says of memory and of what else runs on it (proc(5)).
#include <cstddef>

namespace slamot::bench {

/// Bytes that can be taken without swapping.
std::size_t availableMemory();

/// How far this process's resident memory rises above where it was at construction. One at a time: it
/// restarts the kernel's count of the peak.
class ResidentGrowth {
  public:
    ResidentGrowth();
    /// Bytes, at most, since construction.
    std::size_t peak() const;

  private:
    std::size_t before_;
};

/// The part of the machine's processor time that others have used since construction.
class OtherLoad {
  public:
    OtherLoad();
    double part() const;

  private:
    double busy_, own_, wall_;
};

}  // namespace slamot::bench

#pragma once
#include <stdexcept>

namespace slamot {

/// A log, truth or data file that cannot be used: one sentence with file, place and what was expected.
class LogError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

}  // namespace slamot

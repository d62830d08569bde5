#pragma once
#include <optional>
#include <string>
#include <utility>

namespace slamot::eval {

/// A metric, or the sentence that says why there is none.
template <class T>
class Measured {
  public:
    Measured() : why_absent_("not evaluated") {}
    // Implicit on purpose: a function that computes a metric returns it as it is.
    Measured(T value) : value_(std::move(value)) {}

    static Measured absent(std::string reason) {
        Measured m;
        m.why_absent_ = std::move(reason);
        return m;
    }

    explicit operator bool() const { return value_.has_value(); }
    const T& operator*() const { return value_.value(); }
    const T* operator->() const { return &value_.value(); }
    /// Empty when there is a value.
    const std::string& whyAbsent() const { return why_absent_; }

  private:
    std::optional<T> value_;
    std::string why_absent_;
};

}  // namespace slamot::eval

#pragma once
#include <nlohmann/json.hpp>

#include "slamot/core/data/Pose2.h"

namespace slamot::report {

/// Columns of numbers for JavaScript, with as many digits as can be seen after zooming in twenty times; what
/// is no number is null.
class ReplayColumns {
  public:
    explicit ReplayColumns(int digits) : digits_(digits) {}
    void add(const char* name, double value, int digits);
    void length(const char* name, double value) { add(name, value, digits_); }
    void whole(const char* name, std::int64_t value) { columns_[name].push_back(value); }
    /// "x" and "y".
    void point(const Vector2& p);
    /// At three standard deviations: half axes "a" and "b", and "angle" of the longer one.
    void ellipse(const Matrix2& covariance);
    void unknown(std::initializer_list<const char*> names);
    nlohmann::json& take() { return columns_; }

  private:
    int digits_;
    nlohmann::json columns_ = nlohmann::json::object();
};

}  // namespace slamot::report

#pragma once
// The one place where angles are wrapped.
#include <cmath>

namespace slamot {

inline constexpr double pi = 3.14159265358979323846;

inline constexpr double radians(double degrees) {
    return degrees * (pi / 180.0);
}
inline constexpr double degrees(double radians) {
    return radians * (180.0 / pi);
}

/// The angle in (-pi, pi] that differs from `angle` [rad] by whole turns. Works for doubles and for automatic
/// differentiation scalars, since only whole turns are taken off.
template <class Scalar>
Scalar wrapAngle(const Scalar& angle) {
    using std::ceil;
    const Scalar turns = ceil((angle - Scalar(pi)) / Scalar(2.0 * pi));
    const Scalar wrapped = angle - Scalar(2.0 * pi) * turns;
    // Near odd multiples of pi rounding may end an ulp outside.
    if (wrapped > Scalar(pi)) return wrapped - Scalar(2.0 * pi);
    if (wrapped <= Scalar(-pi)) return wrapped + Scalar(2.0 * pi);
    return wrapped;
}

/// a - b [rad], wrapped.
template <class Scalar>
Scalar angleDifference(const Scalar& a, const Scalar& b) {
    return wrapAngle(Scalar(a - b));
}

}  // namespace slamot

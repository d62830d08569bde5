#pragma once
// A Markov chain of two states in continuous time.
#include <cmath>

namespace slamot {

/// Probabilities that what is in one state is in the other dt [s] later, from how long [s] it stays in each
/// on average; infinite: for ever.
struct TwoStateChain {
    double a_to_b, b_to_a;

    TwoStateChain(double stay_a, double stay_b, double dt) {
        const double leave_a = 1.0 / stay_a, leave_b = 1.0 / stay_b, rate = leave_a + leave_b;
        const double settled = rate > 0 ? -std::expm1(-rate * dt) / rate : 0.0;
        a_to_b = leave_a * settled;
        b_to_a = leave_b * settled;
    }
};

}  // namespace slamot

#include "slamot/core/objects/Existence.h"

#include <algorithm>
#include <cmath>

#include "TwoStateChain.h"

namespace slamot {
namespace {

/// What has been there for long may still be taken away, and rounding must not make it immortal.
constexpr double least_absent = 1e-9;

}  // namespace

Existence Existence::certain() {
    return {};
}

Existence Existence::atFirstSight(double probability) {
    Existence existence;
    existence.certain_ = false;
    existence.visible_ = existence.initial_ = probability;
    return existence;
}

Existence::Existence(const LifeParameters& p) {
    const double all = p.new_per_scan + p.clutter_per_scan;
    // Where neither is expected, what was detected can only be an object.
    *this = atFirstSight(all > 0 ? p.new_per_scan / all : 1.0);
}

void Existence::pass(double dt, const LifeParameters& p) {
    if (certain_) return;
    const TwoStateChain chain(p.hidden_every, p.hidden_for, dt);
    const double shift = visible_ * chain.a_to_b - hidden_ * chain.b_to_a;
    visible_ -= shift;
    hidden_ += shift;
}

void Existence::mayLeave(double dt, double stay) {
    if (certain_) return;
    const double stays = std::exp(-dt / stay);
    visible_ *= stays;
    hidden_ *= stays;
}

void Existence::weigh(double visible) {
    if (certain_) return;
    const double absent = initial_ < 1 ? std::max(1.0 - visible_ - hidden_, least_absent) : 0.0;
    const double all = visible_ * visible + hidden_ + absent;
    visible_ *= visible / all;
    hidden_ /= all;
}

void Existence::detected(double likelihood_ratio) {
    weigh(likelihood_ratio);
}

void Existence::missed(double detection_probability) {
    weigh(1.0 - detection_probability);
}

void Existence::detectedPerhaps(double p, double detection_probability) {
    if (certain_) return;
    missed(detection_probability);
    visible_ = p + (1 - p) * visible_;
    hidden_ *= 1 - p;
}

bool Existence::confirmed(const LifeParameters& p) const {
    return certain_ || probability() >= p.confirm_probability;
}

bool Existence::lost(const LifeParameters& p) const {
    return !certain_ && probability() < p.remove_probability * initial_;
}

void describe(LifeParameters& p, const std::string& objects, ParameterTable& table) {
    table
        .real("detection_probability", p.detection_probability, "-", Interval::openProbability(),
              "Of " + objects + " in view that nothing hides: part of the looks that detect them.")
        .real("clutter_per_scan", p.clutter_per_scan, "-", Interval::nonNegative(),
              "False detections of a sensor that could be " + objects + ", on average.")
        .real("new_per_scan", p.new_per_scan, "-", Interval::nonNegative(),
              "First detections of " + objects + " by a sensor, on average.")
        .real("confirm_probability", p.confirm_probability, "-", Interval::openProbability(),
              "Existence at which " + objects + " join the estimate.")
        .real("remove_probability", p.remove_probability, "-", Interval::openProbability(),
              "Part of the existence at first sight at which " + objects + " are let go.")
        .real("hidden_every", p.hidden_every, "s", Interval::positiveOrInfinite(),
              "Between occlusions of " + objects + " in view, on average; inf: nothing hides them.")
        .real("hidden_for", p.hidden_for, "s", Interval::positive(),
              "How long an occlusion lasts, on average.");
}

}  // namespace slamot

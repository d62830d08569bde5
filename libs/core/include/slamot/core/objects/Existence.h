#pragma once
// Whether an object is there at all: a hidden Markov chain over visible (detected with P_D when looked at),
// hidden (occluded for a while: there, but not detected) and absent (clutter, or gone). doc/maths/objects.md.
#include <string>

#include "slamot/core/config/Parameters.h"

namespace slamot {

/// How objects of one kind, landmarks or movers, appear, show and hide themselves.
struct LifeParameters {
    double detection_probability = 0.9;  ///< P_D of an object in view that nothing hides
    double clutter_per_scan = 1;         ///< false detections of a sensor, on average
    double new_per_scan = 0.1;           ///< first detections of objects, on average
    double confirm_probability = 0.99;   ///< existence at which an object joins the estimate
    double remove_probability = 0.01;    ///< part of its existence at first sight at which it is let go
    double hidden_every = 20;            ///< [s] between occlusions of an object in view, on average
    double hidden_for = 2;               ///< [s] an occlusion lasts, on average
};

/// Adds the keys to a table; `objects` is the plural in their comments.
void describe(LifeParameters& parameters, const std::string& objects, ParameterTable& table);

class Existence {
  public:
    /// Beyond doubt: an object the log gives an identity. Nothing changes it.
    static Existence certain();
    /// At first sight: new / (new + clutter).
    explicit Existence(const LifeParameters& parameters);
    /// At first sight, with that probability, which lies in [0, 1].
    static Existence atFirstSight(double probability);

    /// Time in view passes: occlusions begin and end.
    void pass(double dt, const LifeParameters& parameters);
    /// Time in view passes in which the object may have left for good: it stays there for `stay` [s] on
    /// average.
    void mayLeave(double dt, double stay);
    /// Detected, where that is `likelihood_ratio` times as likely to come from this object, if it is visible,
    /// as from clutter: P_D N(nu; 0, S) / c.
    void detected(double likelihood_ratio);
    /// Not detected, where it would have been, if visible, with that probability, which is below 1: P_D times
    /// the probability that it is in view.
    void missed(double detection_probability);
    /// Detected with probability `p`, else missed as above: the mixture of both.
    void detectedPerhaps(double p, double detection_probability);

    /// Visible or hidden.
    double probability() const { return visible_ + hidden_; }
    /// Part of the time in which a look would show it: P_D times this is what a sensor detects.
    double visibility() const { return visible_; }
    bool confirmed(const LifeParameters& parameters) const;
    /// So unlikely by now that it is to be let go.
    bool lost(const LifeParameters& parameters) const;

  private:
    Existence() = default;
    /// Bayes, from how likely what was seen is of a visible, hidden or absent object: `visible` to 1 to 1.
    void weigh(double visible);

    double visible_ = 1, hidden_ = 0;
    double initial_ = 1;  ///< probability at first sight
    bool certain_ = true;
};

}  // namespace slamot

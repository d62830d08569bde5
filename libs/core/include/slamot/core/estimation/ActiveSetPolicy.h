#pragma once
// Which landmarks the compressed engine keeps active: those the sensors can reach, with a margin.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "slamot/core/config/Parameters.h"
#include "slamot/core/estimation/JointBank.h"

namespace slamot {

struct ActiveSetParameters {
    /// [m] at which landmarks are seen; not given: the sensors' own limits, or the longest range a landmark
    /// was met at where a sensor has none.
    std::optional<double> range;
    double activate_margin = 0.3;  ///< landmarks up to (1 + this) ranges away are activated
    double keep_margin = 0.32;     ///< active ones are kept up to (1 + this) ranges away, or activate_margin
    double view_margin = pi / 3;   ///< [rad] beyond the edge of the field of view, twice that for keeping
    double base_growth = 3;        ///< commit when dim(beta) exceeds this times the active dimension
    double retirable_part = 0.03;  ///< commit when this part of the active landmarks is out of reach
    int keep_at_least = 40;        ///< active landmarks, unless the base grows too large
};

/// The table `[name]`.
ParameterTable describe(ActiveSetParameters& parameters, const std::string& name);

class ActiveSetPolicy {
  public:
    explicit ActiveSetPolicy(const ActiveSetParameters& parameters) : parameters_(parameters) {}

    const ActiveSetParameters& parameters() const { return parameters_; }
    /// Takes note of where the sensors are now, and of how far they see landmarks. A sensor counts from its
    /// first landmark on: one that sees movers only, perhaps from afar, says nothing of the map.
    void look(const Attention& attention);
    /// The longest range of a sensor that counts [m]; 0 before the first landmark.
    double range() const { return range_; }

    /// Whether sensors have used up about half their margins since `refreshed`: what was chosen then has to
    /// be there now, so that the other half is left for what is chosen from here on.
    bool due() const;
    void refreshed();
    /// What to activate next has been chosen, with the sensors where they are now.
    void planned();
    /// Whether it will do until the active set is due again.
    bool planHolds() const;

    bool toActivate(const Vector2& landmark) const {
        return within(landmark, parameters_.activate_margin, 1);
    }
    bool toKeep(const Vector2& landmark) const {
        return within(landmark, std::max(parameters_.keep_margin, parameters_.activate_margin), 2);
    }
    bool worthCommit(int active_dimension, int active_landmarks, int retirable, int base_dimension) const;

  private:
    struct Sensor {
        std::string label;
        double range;  ///< [m] at which it sees landmarks; 0 as long as it has seen none
        double field_of_view;
        Pose2 now;  ///< in the world
        /// Where it was then; nothing when the range was another.
        std::optional<Pose2> at_refresh, at_plan;
    };
    Sensor& of(const RangeBearingSensor& seen);
    /// Whether the sensor has used up this part of a margin.
    bool used(double part, const Sensor& sensor, const std::optional<Pose2>& since) const;
    bool within(const Vector2& landmark, double margin, double view_margins) const;

    ActiveSetParameters parameters_;
    std::vector<Sensor> sensors_;
    double range_ = 0;
};

}  // namespace slamot

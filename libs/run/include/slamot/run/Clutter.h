#pragma once
// Section [clutter]: what is done to a log's detections to see how an estimator bears it.
#include <cstdint>
#include <optional>
#include <vector>

#include "slamot/run/HeldReading.h"

namespace slamot::run {

struct ClutterParameters {
    /// Mean number of false detections added to every range-bearing observation.
    double per_scan = 0;
    /// Of the log's own detections reaching the estimator, each for itself.
    double detection_probability = 1;
    std::optional<std::uint64_t> seed;  ///< the run's where there is none
};

struct ClutterCounts {
    std::int64_t added = 0, withheld = 0;
};

/// Draws are keyed by seed, number of the observation and, for `keeps`, number of the detection: they do not
/// depend on the estimator, nor the false detections on detection_probability.
class Clutter {
  public:
    Clutter(const ClutterParameters& parameters, std::uint64_t run_seed, ClutterCounts& counts);

    bool adds() const { return per_scan_ > 0; }
    /// Whether detection `item` of the observation reaches the estimator; counts it where not.
    bool keeps(const HeldReading& held, std::size_t item);
    /// False detections of the observation, counted: without identity, of the noise that the observation's
    /// detection nearest in range claims, else the sensor. Throws ConfigError where the sensor's range has no
    /// limit.
    std::vector<RangeBearingReading::Item> falseDetections(const HeldReading& held);

  private:
    double per_scan_, detection_probability_;
    std::uint64_t seed_;
    ClutterCounts& counts_;
};

}  // namespace slamot::run

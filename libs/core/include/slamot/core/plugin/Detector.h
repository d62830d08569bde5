#pragma once
// The interface of detector plugins: from a lidar scan and where the robot is believed to be, to range-bearing
// detections.
#include <mrpt/obs/obs_frwds.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/system/COutputLogger.h>

#include <cstdint>
#include <string>
#include <vector>

#include "slamot/core/config/Config.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Detections.h"

namespace slamot {

/// What one return of a scan comes from.
enum class ReturnClass : std::uint8_t { unknown, still, moving, landmark, invalid };

struct Detected {
    RangeBearingSet detections;
    /// One per return, in the scan's order.
    std::vector<ReturnClass> classes;
};

/// Finds landmarks and movers in scans. Poses are handed in as values; a detector never sees the estimator.
class Detector : public mrpt::rtti::CObject, public mrpt::system::COutputLogger {
    DEFINE_VIRTUAL_MRPT_OBJECT(Detector)

   public:
    ~Detector() override;
    Detector(const Detector&) = delete;
    Detector& operator=(const Detector&) = delete;

    virtual std::string name() const = 0;
    virtual std::vector<ParameterTable> parameterTables() = 0;
    /// Throws ConfigError.
    void initialize(const Config& config);

    /// Forgets everything seen.
    virtual void reset() = 0;
    /// `predicted` is the robot's pose at the scan, before the scan's detections have been used.
    virtual Detected detect(const mrpt::obs::CObservation& scan, const PoseGaussian& predicted) = 0;
    /// Puts the scan into the detector's map with the pose after the update.
    virtual void integrate(const mrpt::obs::CObservation& scan, const PoseGaussian& corrected,
                           const std::vector<ReturnClass>& classes) = 0;

   protected:
    Detector();
};

}  // namespace slamot

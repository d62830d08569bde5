#pragma once
// The interface of detector plugins: from a lidar scan and where the robot is believed to be, to range-bearing
// detections.
#include <mrpt/obs/obs_frwds.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/system/COutputLogger.h>

#include <cstdint>
#include <stdexcept>
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

/// A detector gave what no estimator can take: one sentence with detector and detection.
class DetectorError : public std::runtime_error {
   public:
    using std::runtime_error::runtime_error;
};

/// Finds landmarks and movers in scans. Poses are handed in as values; a detector never sees the estimator.
class Detector : public mrpt::rtti::CObject, public mrpt::system::COutputLogger {
    DEFINE_VIRTUAL_MRPT_OBJECT(Detector)

   public:
    ~Detector() override;
    Detector(const Detector&) = delete;
    Detector& operator=(const Detector&) = delete;

    virtual std::string name() const = 0;
    std::vector<ParameterTable> parameterTables() { return onParameters(); }
    /// Reads the plugin's sections. Throws ConfigError.
    void initialize(const Config& config);
    /// Forgets everything seen.
    void reset() { onReset(); }

    /// `predicted` is the robot's pose at the scan, before the scan's detections have been used. Throws
    /// DetectorError for detections that are not finite, have no definite covariance or name no sensor.
    Detected detect(const mrpt::obs::CObservation& scan, const PoseGaussian& predicted);
    /// Puts the scan into the detector's map with the pose after the update.
    void integrate(const mrpt::obs::CObservation& scan, const PoseGaussian& corrected,
                   const std::vector<ReturnClass>& classes) {
        onIntegrate(scan, corrected, classes);
    }

   protected:
    Detector();

    virtual std::vector<ParameterTable> onParameters() = 0;
    /// Parameters have been read; as Estimator::onInitialize.
    virtual void onInitialize(const Config& /*config*/) {}
    virtual void onReset() = 0;
    virtual Detected onDetect(const mrpt::obs::CObservation& scan, const PoseGaussian& predicted) = 0;
    virtual void onIntegrate(const mrpt::obs::CObservation& scan, const PoseGaussian& corrected,
                             const std::vector<ReturnClass>& classes) = 0;
};

}  // namespace slamot

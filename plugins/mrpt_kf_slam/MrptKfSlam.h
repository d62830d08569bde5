#pragma once
#include <slamot/core/models/RobotMotion.h>
#include <slamot/core/plugin/Estimator.h>

#include <map>
#include <memory>

namespace slamot {

/// MRPT's own EKF-SLAM (CRangeBearingKFSLAM2D, the class behind its program kf-slam) as an estimator: the
/// peer that studies and the leaderboard put beside slamot's. It maps landmarks of known identity and ignores
/// movers.
class MrptKfSlam : public Estimator {
    DEFINE_MRPT_OBJECT(MrptKfSlam, slamot)

  public:
    ~MrptKfSlam() override;
    std::string name() const override { return "mrpt_kf_slam"; }
    std::string missingInOdometry(const OdometryIncrement& odometry) const override {
        return missingField(motion_, odometry);
    }

  protected:
    std::vector<ParameterTable> onParameters() override;
    void onStart(const Start& start) override;
    void onPredict(const OdometryIncrement& odometry) override;
    UpdateReport onUpdate(const DetectionSet& set) override;
    PoseGaussian onRobot() const override;
    std::vector<LandmarkEstimate> onLandmarks() const override;
    std::int64_t onLandmarkCount() const override { return static_cast<std::int64_t>(seen_.size()); }

  private:
    /// When and how often each landmark was seen, by the log's identity; ids count up in order of appearance.
    struct Seen {
        LandmarkId id;
        std::int64_t count = 0;
        Stamp first, last;
    };
    /// What one sensor saw, as MRPT takes it in: all at once, after the movement since the last time.
    void process(const DetectionSet& set, int sensor, UpdateReport& report);
    void takeMovement();

    class Filter;
    std::unique_ptr<Filter> filter_;
    RobotMotionParameters motion_;
    PoseGaussian moved_;  ///< since the filter's last step, in its robot's frame
    std::map<SourceId, Seen> seen_;
};

}  // namespace slamot

#pragma once
// What the plugins of particle filters have in common: each adds its parameters and says how its filter is made.
#include <memory>
#include <utility>
#include <vector>

#include "slamot/core/models/RobotMotion.h"
#include "slamot/core/plugin/Estimator.h"

namespace slamot {

/// `Filter` is ParticleFilter or has its public calls. A plugin's onStart calls begin(); a filter with movers also
/// overrides onTracks.
template <class Filter>
class ParticleEstimator : public Estimator {
  public:
    std::string missingInOdometry(const OdometryIncrement& odometry) const override {
        return missingField(motion_, odometry);
    }

  protected:
    /// `[motion]`, then `tables`, then those of the map.
    std::vector<ParameterTable> withMotion(std::vector<ParameterTable> tables, std::vector<ParameterTable> of_map = {}) {
        tables.insert(tables.begin(), describe(motion_));
        for (ParameterTable& table : of_map) tables.push_back(std::move(table));
        return tables;
    }
    /// Makes the filter of these and starts it.
    template <class... Arguments>
    void begin(const Start& start, Arguments&&... arguments) {
        filter_ = std::make_unique<Filter>(std::forward<Arguments>(arguments)...);
        filter_->start(start.pose, start.seed);
    }
    const RobotMotionParameters& motion() const { return motion_; }
    const Filter& filter() const { return *filter_; }

    void onPredict(const OdometryIncrement& odometry) override { filter_->predict(odometry); }
    UpdateReport onUpdate(const DetectionSet& detections) override { return filter_->update(detections); }
    PoseGaussian onRobot() const override { return filter_->robot(); }
    std::vector<ParticleEstimate> onParticles() const override { return filter_->particles(); }
    std::vector<LandmarkEstimate> onLandmarks() const override { return filter_->landmarks(); }
    std::vector<LandmarkEstimate> onLandmarks(const std::vector<LandmarkId>& ids) const override {
        return filter_->landmarks(ids);
    }
    std::int64_t onLandmarkCount() const override { return filter_->landmarkCount(); }
    std::vector<LandmarkEstimate> onTentative() const override { return filter_->tentative(); }

  private:
    RobotMotionParameters motion_;
    std::unique_ptr<Filter> filter_;
};

}  // namespace slamot

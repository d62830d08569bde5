#pragma once
// One mover given one particle's path: a Gaussian for each motion it may be in (paper 2, section 2.3; with several
// modes the IMM of paper 1, section 2.3, in each particle). doc/plugins/pf_slamot.md.
#include <vector>

#include "slamot/core/estimation/RelativeGaussian.h"
#include "slamot/core/estimation/TargetMixture.h"
#include "slamot/core/estimation/TargetModes.h"
#include "slamot/core/models/ControlledTarget.h"
#include "slamot/core/particles/PointSight.h"

namespace slamot {

enum class TargetDrive {
    modes,   ///< [p v a] by the target models, one or several
    control  ///< [x y theta] by a known speed and turn rate (paper 2)
};

/// What the filters of all movers have in common.
struct TargetSettings {
    TargetDrive drive = TargetDrive::modes;
    ControlledTarget control;
    std::vector<TargetModel> models{TargetModel()};
    ModeChain chain;
    Eigen::VectorXd initial = Eigen::VectorXd::Ones(1);  ///< mode probabilities at first sight
    GaussianTransform transform = GaussianTransform::linear;
};

/// A prediction over `dt` [s], as far as it is the same for all particles.
struct TargetStep {
    TargetStep(const TargetSettings& settings, double dt);

    double dt;
    Eigen::MatrixXd p;                     ///< mode transitions
    std::vector<TargetPrediction> linear;  ///< F and Q by mode, where they do not depend on the state
};

/// A detection of a mover.
struct TargetSight {
    Vector2 z;
    Matrix2 R;
    Pose2 sensor;
};

class TargetFilter {
  public:
    /// At first sight from a known pose [x y theta]. `mover`: [p v a] in the robot's frame.
    TargetFilter(const TargetSettings& settings, const RelativeGaussian& mover, const Vector3& pose);

    void predict(const TargetSettings& settings, const TargetStep& step);
    /// Conditions on a detection from a known pose; log of its likelihood, 1/(m rad).
    double update(const TargetSettings& settings, const Vector3& pose, const TargetSight& sight);

    /// Moments over modes.
    GaussianPoint position() const;
    TargetGaussian merged(const TargetSettings& settings) const;
    /// Of modes; under `control`, of the headings that are left.
    const Eigen::VectorXd& probabilities() const { return mu_; }
    const TargetGaussian& mode(int j) const { return modes_[static_cast<std::size_t>(j)]; }

  private:
    void startHeadings(const ControlledTarget& control, const NewBlock& mover);
    void predictHeadings(const TargetSettings& settings, double dt);
    /// Lets go of refuted headings, and makes one Gaussian of those near one another.
    void joinHeadings();

    Eigen::VectorXd mu_;
    /// Under `control` the first three entries of each are [x y theta], theta not wrapped, and the rest is 0.
    std::vector<TargetGaussian> modes_;
};

}  // namespace slamot

#pragma once
// Particles with landmarks and movers: what PF-SLAMOT believes, and what can be done to it. All particles
// have the same movers, so one number stands for a mover in all of them.
#include <map>
#include <vector>

#include "slamot/core/estimation/JointBank.h"
#include "slamot/core/estimation/ModalState.h"
#include "slamot/core/particles/LandmarksAndTargets.h"
#include "slamot/core/particles/ParticleFilter.h"

namespace slamot {

/// First two moments of robot and movers over all particles, correlations included.
class MergedTargets : public JointView {
  public:
    MergedTargets(std::vector<BlockId> targets, const Eigen::VectorXd& mean,
                  const Eigen::MatrixXd& covariance)
        : targets_(std::move(targets)), mean_(mean), P_(covariance) {}

    BlockVector mean(BlockId block) const override;
    BlockMatrix covariance(BlockId a, BlockId b) const override;
    Eigen::MatrixXd jointCovariance(const std::vector<BlockId>& blocks) const override;

  private:
    struct Rows {
        Eigen::Index first, count;
    };
    Rows rowsOf(BlockId block) const;

    std::vector<BlockId> targets_;
    Eigen::VectorXd mean_;
    Eigen::MatrixXd P_;
};

/// A detection of a mover that all particles are to take in.
struct TargetDetection {
    BlockId target;
    int detection;  ///< index in the batch
    TargetSight sight;
    bool named = true;  ///< it is the mover's beyond doubt
    /// Else: the mover is visible with that probability and detected with density detection_probability N(z),
    /// or the detection came about with this density [1/(m rad)].
    double visible = 1, detection_probability = 1, unexplained = 1;
};

/// What particles say of a detection that may be of a landmark or of a mover.
struct LandmarkVerdict {
    int detection;        ///< index in the batch
    LandmarkId landmark;  ///< that particles of most of the weight take it for; none otherwise
    bool explained;       ///< most take it for some landmark
    bool may_be_new;      ///< most know nothing that it could be of
};

class TargetParticles {
  public:
    TargetParticles(const ParticleParameters& parameters, const RobotMotionParameters& motion,
                    const LandmarksAndTargets::Settings& settings, const ScanMaker& scans, bool weigh_targets,
                    int threads);

    void start(const PoseGaussian& pose, std::uint64_t seed);
    void predict(const OdometryIncrement& odometry);

    /// Landmarks of a batch: poses, maps and weights; the report tells of landmarks alone. fixes_poses: poses
    /// are points afterwards, whatever there is in the batch. `visible`: probability that a mover is there
    /// and not hidden, 1 where nothing is said.
    UpdateReport updateByLandmarks(const DetectionSet& set, bool fixes_poses,
                                   const std::map<BlockId, double>& visible = {});
    /// Of that batch's detections of unknown kind.
    std::vector<LandmarkVerdict> landmarkVerdicts() const;
    /// Then movers; afterwards it is time to resample.
    void updateByTargets(const std::vector<TargetDetection>& detections);
    void resample() { particles_.resample(); }

    /// Both in all particles at once; poses are points then. `target`: [p v a], robot's frame.
    BlockId addTarget(const RelativeGaussian& target);
    /// Number and point are filled in, from sights of this and earlier scans (LandmarksAndTargets::pointOf),
    /// which weigh particles now.
    LandmarkId addLandmark(const std::vector<TentativeSight>& sights, double gate, LandmarkFilter landmark);
    void removeTarget(BlockId target);
    void removeLandmark(LandmarkId landmark);

    /// What the heaviest of the particles that have a landmark makes of it; null where these have no more
    /// than half of the weight.
    struct FoundLandmark {
        const LandmarkFilter* landmark;
        Vector3 pose;
    };
    FoundLandmark findMostly(LandmarkId landmark) const;

    MergedTargets merged() const;
    TargetBelief target(BlockId target) const;
    const ParticleFilter<LandmarksAndTargets>& particles() const { return particles_; }

  private:
    std::size_t indexOf(BlockId target) const;
    /// Whether a particle took a detection of the batch for a landmark's.
    bool landmarkTook(int particle, int detection) const;

    LandmarksAndTargets::Settings settings_;
    bool weigh_targets_;
    ParticleFilter<LandmarksAndTargets> particles_;
    ParticleScan scan_;             ///< the last one
    std::vector<BlockId> targets_;  ///< in the order that particles have them
    BlockId last_target_ = robot_block;
};

}  // namespace slamot

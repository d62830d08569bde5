#pragma once
// One particle's map of PF-SLAMOT (paper 2, figure 2): landmarks and movers, given its path. As a Map (ParticleFilter.h)
// it is its landmarks; movers pass the time and take in their detections afterwards, when it is known which are theirs
// (doc/plugins/pf_slamot.md). All particles have the same movers in the same order.
#include <vector>

#include "slamot/core/objects/TentativeObjects.h"
#include "slamot/core/particles/LandmarkFilters.h"
#include "slamot/core/particles/TargetFilter.h"

namespace slamot {

class LandmarksAndTargets {
  public:
    struct Settings {
        LandmarkFilters::Settings landmarks;
        TargetSettings targets;
        double target_detection_probability;
    };
    using Work = LandmarkFilters::Work;

    void renew(std::uint64_t owner) { landmarks_.renew(owner); }

    /// A sight of unknown kind that is likelier of a mover than of any landmark is left alone.
    void pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work,
                std::vector<SightRecord>& records) const;
    void refine(const Settings& settings, const ParticleScan& scan, const Work& work, RefinedPose& pose) const {
        landmarks_.refine(settings.landmarks, scan, work, pose);
    }
    double update(const Settings& settings, const Vector3& pose, bool drawn, const ParticleScan& scan, Work& work,
                  std::vector<SightRecord>& records) {
        remember(pose, scan);
        return landmarks_.update(settings.landmarks, pose, drawn, scan, work, records);
    }

    /// A landmark as its sights show it from where this particle's path has them made; those it remembers, the present
    /// scan's among them. Sights after the first of a NIS above `gate` were of something else. Adds the log of the
    /// likelihood of all after the first.
    GaussianPoint pointOf(const Settings& settings, const std::vector<TentativeSight>& sights, double gate,
                          double& log_likelihood) const;

    const LandmarkFilter* find(LandmarkId id) const { return landmarks_.find(id); }
    static bool isConfirmed(const Settings& settings, const LandmarkFilter& landmark) {
        return LandmarkFilters::isConfirmed(settings.landmarks, landmark);
    }
    template <class Visit>
    void forEachConfirmed(const Settings& settings, const Visit& visit) const {
        landmarks_.forEachConfirmed(settings.landmarks, visit);
    }

    const SharedPages<LandmarkFilter>& features() const { return landmarks_.features(); }

    LandmarkFilters& landmarks() { return landmarks_; }
    std::vector<TargetFilter>& targets() { return targets_; }
    const std::vector<TargetFilter>& targets() const { return targets_; }

  private:
    struct PastPose {
        Stamp at;
        Vector3 pose;
    };
    void remember(const Vector3& pose, const ParticleScan& scan);
    void findSightsOfMovers(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work) const;

    LandmarkFilters landmarks_;
    std::vector<TargetFilter> targets_;
    std::vector<PastPose> path_;  ///< at the latest scans that showed what may be of either kind, oldest first
};

}  // namespace slamot

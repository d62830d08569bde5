#pragma once
// One particle's map as a Poisson multi-Bernoulli density: features that exist with a probability and have a
// Gaussian position, independent of one another, and a Poisson number of features not detected yet. One step
// is that of the track-oriented marginal filter TOMB/P (J. L. Williams, IEEE Transactions on Aerospace and
// Electronic Systems 51(3), 2015, section IV.B): a detection is of each feature, of something new or false
// with its probability over all pairings, and each feature becomes the mixture of what it would be with each
// of them. doc/plugins/pmb_ufastslam.md.
#include <algorithm>
#include <limits>
#include <vector>

#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/objects/Existence.h"
#include "slamot/core/particles/MixedEstimate.h"
#include "slamot/core/particles/ParticleScan.h"
#include "slamot/core/particles/PointSight.h"
#include "slamot/core/particles/RivalFeatures.h"
#include "slamot/core/particles/SharedPages.h"
#include "slamot/core/particles/UndetectedFeatures.h"

namespace slamot {

struct AssociationMarginals;

struct BernoulliMapParameters {
    /// Nothing hides landmarks: what may be hidden is long kept while it is missed, and after a loop that was
    /// not closed that is the old map.
    BernoulliMapParameters() { life.hidden_every = std::numeric_limits<double>::infinity(); }

    bool use_nameless = true;  ///< false: detections without identity are ignored
    double gate_probability = 1 - 1e-6;
    /// A feature refines the pose where its detection comes from it with this probability at least.
    double pose_probability = 0.9;
    int state_budget = 500;  ///< of exact sums over the pairings of a cluster
    double density = 0.005;  ///< [1/m^2] of features where no sensor has looked yet
    LifeParameters life;
    double merge_probability = 0.99;  ///< of being one, at which two features are merged
    double max_unseen = 5;  ///< [s]; a feature that is not confirmed and not seen for longer is let go
};

/// Tables `[name.association]` and `[name.landmarks]`.
std::vector<ParameterTable> describe(BernoulliMapParameters& parameters, const std::string& name);

struct BernoulliFeature {
    LandmarkId id;
    GaussianPoint point;
    SourceId source;
    Existence existence = Existence::certain();
    std::int64_t seen = 1;
    Stamp first_seen, last_seen;
    Stamp looked;      ///< when its existence was judged last
    LandmarkId rival;  ///< an older feature that may be the same one
    double same = 0;   ///< log odds that it is, as far as scans tell

    double existenceProbability() const { return existence.probability(); }
};

class BernoulliMap {
  public:
    using Place = SharedPages<BernoulliFeature>::Place;

    /// What all particles' maps have in common.
    struct Settings {
        Settings(const BernoulliMapParameters& parameters, GaussianTransform transform);
        BernoulliMapParameters parameters;
        GaussianTransform transform;
        double gate, rival_gate;  ///< of the NIS
        double merge_odds;        ///< logarithm
    };
    /// Room for one update, used again for the next particle.
    struct Work {
        /// A feature that may be in view.
        struct Near {
            Place place;
            GaussianPoint point;
            Existence existence;
            double detection;  ///< probability that it is detected, if it is visible, where something is
            PointSight sight;
            bool at_pose;  ///< whether `sight` is from the drawn pose

            /// The same where nothing is detected: beside the field of view a miss says nothing.
            double miss() const { return detection > least_missed ? detection : 0; }
            static constexpr double least_missed = 0.02;
        };
        /// A detection that is of a feature beyond doubt, at the predicted pose.
        struct Pair {
            int sight;
            GaussianPoint point;
        };
        int view = -1;  ///< that what follows is of
        std::vector<Near> near;
        std::vector<Candidate> candidates;
        std::vector<double> log_ratios;  ///< by candidate
        /// By sight: density [1/(m rad)] of first detections of features, and of those and false ones.
        std::vector<double> fresh, unexplained;
        std::vector<Pair> pairs;
        std::vector<FeatureMixture> mixtures;  ///< by near feature
        std::vector<RivalSight> rival_sights;
        std::vector<Place> lost;  ///< to be removed at the end of the scan

        bool isLost(Place place) const { return std::find(lost.begin(), lost.end(), place) != lost.end(); }
    };

    void renew(std::uint64_t owner) {
        features_.renew(owner);
        undetected_.renew(owner);
    }

    /// Probabilities of pairs at the predicted pose; fills `records` by sight with the likeliest.
    void pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work,
                std::vector<SightRecord>& records) const;
    /// The pose with what the pairs beyond doubt say of it, sight after sight.
    void refine(const Settings& settings, const ParticleScan& scan, const Work& work,
                RefinedPose& pose) const;
    /// Takes the scan in at a known pose. Returns the log of its likelihood given the map before: of the sum
    /// over all pairings, exact in clusters within the state budget, Bethe's approximation in others; up to a
    /// term that all poses share.
    double update(const Settings& settings, const Vector3& pose, bool drawn, const ParticleScan& scan,
                  Work& work, std::vector<SightRecord>& records);

    const BernoulliFeature* find(LandmarkId id) const { return features_.find(id); }
    static bool isConfirmed(const Settings& settings, const BernoulliFeature& feature) {
        return feature.existence.confirmed(settings.parameters.life);
    }
    template <class Visit>
    void forEachConfirmed(const Settings& settings, const Visit& visit) const {
        features_.forEach([&](const BernoulliFeature& feature) {
            if (isConfirmed(settings, feature)) visit(feature);
        });
    }
    const SharedPages<BernoulliFeature>& features() const { return features_; }

  private:
    void findNear(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, int view,
                  Work& work) const;
    void expectUnexplained(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                           Work& work) const;
    static void findCandidates(const Settings& settings, const ParticleScan& scan, Work& work);
    static void lookAgain(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                          Work& work);
    double updateNamed(const Settings& settings, const Vector3& pose, const ParticleScan& scan, int view,
                       std::vector<SightRecord>& records);
    double updateNameless(const Settings& settings, const Vector3& pose, bool drawn, const ParticleScan& scan,
                          int view, Work& work, std::vector<SightRecord>& records, std::vector<double>& none);
    void take(Stamp now, double missed, std::size_t near, const Work& work);
    void findRivals(const Settings& settings, const AssociationProblem& problem, const Work& work);
    void weighRivals(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                     const AssociationMarginals& marginals, Work& work);
    double logSame(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
                   const AssociationMarginals& marginals, int older, int younger, Work& work) const;
    void merge(Place older, Place younger);
    void start(const Settings& settings, const Vector3& pose, const ParticleScan& scan,
               const ScanSight& sight, double existence);
    void letGo(const Settings& settings, Stamp now, Work& work);

    SharedPages<BernoulliFeature> features_;
    UndetectedFeatures undetected_;
};

}  // namespace slamot

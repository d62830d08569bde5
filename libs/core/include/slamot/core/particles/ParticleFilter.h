#pragma once
// The Rao-Blackwellised particle filter (paper 2, section 3; paper 4, section 3): each particle has a path and,
// given it, a map. What a map is made of is the parameter `Map`; FastSLAM 1 and 2, UFastSLAM, the set filters and
// PF-SLAMOT differ in it, in the proposal and in the transform.
//
// A Map is a value, cheap to copy, with
//   struct Settings;                               what all particles' maps have in common
//   struct Work;                                   room for one update, used again for the next particle
//   void renew(owner);                             it has been copied: nothing it holds is its own
//   void pairUp(settings, PoseBelief, scan, Work&, records&) const;
//                                                  which sight is of what, at the predicted pose
//   void refine(settings, scan, Work, RefinedPose&) const;
//                                                  what these pairs say of the pose
//   double update(settings, pose, drawn, scan, Work&, records&);
//                                                  takes the scan in at a known pose (drawn: another one than pairs were
//                                                  found at); log of its likelihood
//   forEachConfirmed(settings, visit(feature)), find(id), isConfirmed(settings, feature), features().forEach(visit);
//                                                  features with id, point, source, seen, stamps and
//                                                  existenceProbability(); forEach visits all
#include <algorithm>
#include <utility>
#include <vector>

#include "slamot/core/data/Estimate.h"
#include "slamot/core/data/Odometry.h"
#include "slamot/core/particles/MixedEstimate.h"
#include "slamot/core/particles/ParticleCloud.h"
#include "slamot/core/particles/ParticleScan.h"
#include "slamot/core/threads/Workers.h"

namespace slamot {

template <class Map>
class ParticleFilter {
  public:
    using Settings = typename Map::Settings;

    ParticleFilter(const ParticleParameters& parameters, const RobotMotionParameters& motion, Settings settings,
                   ScanMaker scans, int threads)
        : settings_(std::move(settings)), scans_(std::move(scans)), cloud_(parameters, motion), workers_(threads) {}

    void start(const PoseGaussian& pose, std::uint64_t seed) {
        cloud_.start(pose, seed);
        scans_.clear();
        maps_.assign(static_cast<std::size_t>(cloud_.count()), Map());
        records_.assign(maps_.size(), {});
        log_likelihoods_.assign(maps_.size(), 0);
        for (Map& map : maps_) map.renew(++owners_);
    }

    void predict(const OdometryIncrement& odometry) { cloud_.predict(odometry, workers_); }

    UpdateReport update(const DetectionSet& set) {
        UpdateReport report = look(scans_.scan(set), set.rangeBearing());
        resample();
        return report;
    }

    // A filter that knows more of a batch than maps do puts its step together from the following.

    ScanMaker& scans() { return scans_; }
    /// What maps say of a scan: new poses and weights, the old particles.
    UpdateReport look(const ParticleScan& scan, const RangeBearingSet& seen) {
        UpdateReport report = emptyReport(seen);
        if (scan.sights.empty() && !scan.nameless && !scan.fixes_poses) return report;
        workers_.forRanges(cloud_.count(), [&](int first, int last) {
            typename Map::Work work;
            for (int i = first; i < last; ++i) take(i, scan, work);
        });
        // Innovations are told as they were expected: with the weights before the scan.
        before_ = cloud_.weights();
        cloud_.weigh(log_likelihoods_);
        fillReport(scan, before_, cloud_.weights().best(), records_, report);
        return report;
    }
    /// Weights before the last scan that was looked at.
    const ParticleWeights& weightsBefore() const { return before_; }
    /// What each particle made of the sights of that scan.
    const std::vector<SightRecord>& records(int i) const { return records_[static_cast<std::size_t>(i)]; }
    /// Calls visit(i, map, pose) for each particle, in parallel.
    template <class Visit>
    void forEachParticle(const Visit& visit) {
        workers_.forRanges(cloud_.count(), [&](int first, int last) {
            for (int i = first; i < last; ++i) visit(i, maps_[static_cast<std::size_t>(i)], cloud_.pose(i));
        });
    }
    /// More news of the same time, given what is known by now.
    bool weigh(const std::vector<double>& log_likelihoods) { return cloud_.weigh(log_likelihoods); }
    /// When it is time to.
    void resample() {
        const std::vector<int> parents = cloud_.resample();
        if (parents.empty()) return;
        std::vector<Map> children(maps_.size());
        for (std::size_t k = 0; k < parents.size(); ++k) {
            const std::size_t parent = static_cast<std::size_t>(parents[k]);
            const bool only = (k == 0 || parents[k - 1] != parents[k]) &&
                              (k + 1 == parents.size() || parents[k + 1] != parents[k]);
            if (only) {
                children[k] = std::move(maps_[parent]);
                continue;
            }
            children[k] = maps_[parent];
            children[k].renew(++owners_);
        }
        maps_ = std::move(children);
    }

    PoseGaussian robot() const { return cloud_.robot(); }
    std::vector<ParticleEstimate> particles() const { return cloud_.particles(); }

    /// Those of the heaviest particle, each merged over the particles that have it too.
    std::vector<LandmarkEstimate> landmarks() const {
        std::vector<LandmarkEstimate> out;
        best().forEachConfirmed(settings_, [&](const auto& feature) { out.push_back(merged(feature)); });
        return out;
    }
    std::vector<LandmarkEstimate> landmarks(const std::vector<LandmarkId>& ids) const {
        std::vector<LandmarkEstimate> out;
        for (const LandmarkId id : ids) {
            const auto* feature = best().find(id);
            if (feature && Map::isConfirmed(settings_, *feature)) out.push_back(merged(*feature));
        }
        return out;
    }
    /// Likewise, what is not confirmed.
    std::vector<LandmarkEstimate> tentative() const {
        std::vector<LandmarkEstimate> out;
        best().features().forEach([&](const auto& feature) {
            if (!Map::isConfirmed(settings_, feature)) out.push_back(merged(feature));
        });
        return out;
    }
    std::int64_t landmarkCount() const {
        std::int64_t count = 0;
        best().forEachConfirmed(settings_, [&](const auto&) { ++count; });
        return count;
    }

    const ParticleCloud& cloud() const { return cloud_; }
    const Map& map(int i) const { return maps_[static_cast<std::size_t>(i)]; }
    const Map& best() const { return map(cloud_.weights().best()); }

  private:
    /// A step of one particle: association at the predicted pose, proposal, draw, map, weight.
    void take(int i, const ParticleScan& scan, typename Map::Work& work) {
        const std::size_t k = static_cast<std::size_t>(i);
        Map& map = maps_[k];
        map.pairUp(settings_, cloud_.pose(i), scan, work, records_[k]);
        double log_ratio = 0;
        const bool drawn = !cloud_.pose(i).isPoint();
        if (drawn) {
            RefinedPose refined(cloud_.pose(i));
            map.refine(settings_, scan, work, refined);
            RandomStream random = cloud_.proposalStream(i);
            const RefinedPose::Draw draw = refined.draw(random);
            cloud_.place(i, draw.pose);
            log_ratio = draw.log_ratio;
        }
        log_likelihoods_[k] =
            log_ratio + map.update(settings_, cloud_.pose(i).mean, drawn, scan, work, records_[k]);
    }

    template <class Feature>
    LandmarkEstimate merged(const Feature& feature) const {
        FeatureMixture mixture;
        for (int i = 0; i < cloud_.count(); ++i)
            if (const auto* same = map(i).find(feature.id)) mixture.add(cloud_.weights()[i], same->point);
        return landmarkEstimate(feature, mixture.moments());
    }

    Settings settings_;
    ScanMaker scans_;
    ParticleCloud cloud_;
    ParticleWeights before_;
    Workers workers_;
    std::vector<Map> maps_;
    std::vector<std::vector<SightRecord>> records_;
    std::vector<double> log_likelihoods_;
    std::uint64_t owners_ = 0;
};

}  // namespace slamot

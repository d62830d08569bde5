#pragma once
// One particle's map as a probability hypothesis density in Gaussians (paper 4, eq. 21 to 31): how many
// landmarks are where, without saying which detection is of which. doc/plugins/gmphd_ufastslam.md derives
// what differs from the paper.
#include <vector>

#include "slamot/core/data/Estimate.h"
#include "slamot/core/particles/ParticleScan.h"
#include "slamot/core/particles/PhdScan.h"
#include "slamot/core/particles/PhdTerms.h"
#include "slamot/core/particles/SharedPages.h"

namespace slamot {

/// A component of the density.
struct PhdFeature {
    LandmarkId id;
    GaussianPoint point;
    double weight = 0;      ///< expected number of landmarks
    std::int64_t seen = 1;  ///< scans in which it was detected rather than missed
    Stamp first_seen, last_seen;
    static constexpr SourceId source{};  ///< a density knows no names

    double existenceProbability() const { return weight < 1 ? weight : 1; }
};

class PhdMap {
  public:
    using Place = SharedPages<PhdFeature>::Place;

    /// What all particles' maps have in common.
    struct Settings {
        Settings(const PhdMapParameters& parameters, GaussianTransform transform);
        PhdMapParameters parameters;
        GaussianTransform transform;
        double log_detection, birth_weight;
    };

    /// A component within reach.
    struct Near {
        Place place;
        LandmarkId id;
        double weight;
        GaussianPoint point;
    };
    /// The landmark behind a sight, at the predicted pose.
    struct Pair {
        int near = -1;              ///< -1: none
        double responsibility = 0;  ///< P_D w q / (c + sum P_D w q)
        Vector2 z;                  ///< expected
        Matrix2 S;
    };
    /// A component that may be detected.
    struct Seen {
        Near from;
        bool surely;          ///< a look that does not detect it counts as a miss
        double detected = 0;  ///< weight of its terms with detections
        bool kept = false;    ///< a term goes on in its place
    };
    /// What a sight is in the density.
    struct Share {
        double all = 0;         ///< c + sum P_D w q
        double explained = 0;   ///< part of it that is the components'
        double largest = 0;     ///< weight of a term
        int component = -1;     ///< of that term; -1: no component explains any of it
        bool numbered = false;  ///< its number is given away
    };
    /// Room for one update with one scan, used again for the next particle.
    struct Work {
        const ParticleScan* of = nullptr;  ///< that `scan` was made of
        PhdScan scan;
        std::vector<Near> near;  ///< all within `radius` of `centre`
        Vector2 centre = Vector2::Zero();
        double radius = 0;
        std::vector<Pair> pairs;    ///< by sight
        std::vector<Share> shares;  ///< by sight
        std::vector<Seen> seen;
        std::vector<PhdTerm> terms;
        PhdGroups merged;
        std::vector<Place> lost;
        std::vector<PhdFeature> fresh;  ///< what joins the map at the end

        /// The term at `k` in the order of groups.
        const PhdTerm& member(int k) const {
            return terms[static_cast<std::size_t>(merged.order[static_cast<std::size_t>(k)])];
        }
        Seen& seenOf(const PhdTerm& term) { return seen[static_cast<std::size_t>(term.component)]; }
    };

    void renew(std::uint64_t owner) { features_.renew(owner); }

    /// Finds which landmark is behind which sight, at the predicted pose: responsibility above 1/2.
    void pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work,
                std::vector<SightRecord>& records) const;
    /// The pose with what these landmarks say of it, sight after sight.
    void refine(const Settings& settings, const ParticleScan& scan, const Work& work,
                RefinedPose& pose) const;
    /// The density's update at a known pose, after pairUp; `drawn` makes no difference to it. Returns the log
    /// of the scan's likelihood given the map before, up to what is the same for all particles.
    double update(const Settings& settings, const Vector3& pose, bool drawn, const ParticleScan& scan,
                  Work& work, std::vector<SightRecord>& records);

    const PhdFeature* find(LandmarkId id) const { return features_.find(id); }
    static bool isConfirmed(const Settings& settings, const PhdFeature& feature) {
        return feature.weight > settings.parameters.landmark_above;
    }
    template <class Visit>
    void forEachConfirmed(const Settings& settings, const Visit& visit) const {
        features_.forEach([&](const PhdFeature& feature) {
            if (isConfirmed(settings, feature)) visit(feature);
        });
    }
    /// All components, also those that count for no landmark.
    const SharedPages<PhdFeature>& features() const { return features_; }

  private:
    void findNear(const Vector2& centre, double radius, Work& work) const;
    static void correct(const Settings& settings, const Vector3& pose, int view, Work& work);
    void write(const Settings& settings, const Vector3& pose, int view, Work& work);
    void leaveBehind(const Settings& settings, const Vector2& position, Work& work);

    SharedPages<PhdFeature> features_;
};

}  // namespace slamot

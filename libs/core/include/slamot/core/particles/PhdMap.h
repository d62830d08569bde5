#pragma once
// One particle's map as a probability hypothesis density in Gaussians (paper 4, eq. 21 to 31): how many landmarks are
// where, without saying which detection is of which. doc/plugins/gmphd_ufastslam.md derives what differs from the paper.
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
        double log_detection, log_least, birth_weight;
    };

    struct Near {
        Place place;
        LandmarkId id;
        double weight;
        GaussianPoint point;
    };
    /// A component that may be detected.
    struct Seen {
        Near from;
        bool surely;          ///< it would be
        double detected = 0;  ///< weight of its terms with detections
        bool kept = false;    ///< something goes on in its place
    };
    /// A detection and a landmark.
    struct Pair {
        int near = -1;
        double responsibility = 0;
        Vector2 z;
        Matrix2 S;
    };
    /// What becomes of a detection in the density.
    struct Share {
        double all;          ///< c + sum P_D w q
        double explained;    ///< by components
        double largest;      ///< weight of a term with it
        int component;       ///< of that term
        bool numbered;       ///< its number is given away
    };
    /// Room for one update, used again for the next particle.
    struct Work {
        const ParticleScan* of = nullptr;  ///< that `scan` was made of
        PhdScan scan;
        std::vector<Near> near;  ///< all within `radius` of `centre`
        Vector2 centre;
        double radius;
        std::vector<Pair> pairs;  ///< by sight
        std::vector<Share> shares;  ///< by sight
        std::vector<Seen> seen;
        std::vector<PhdTerm> terms;
        PhdGroups merged;
        std::vector<Place> lost;
        std::vector<PhdFeature> fresh;
    };

    void renew(std::uint64_t owner) { features_.renew(owner); }

    /// Finds which landmark is behind which sight, at the predicted pose: responsibility above 1/2.
    void pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work,
                std::vector<SightRecord>& records) const;
    /// The pose with what these landmarks say of it, sight after sight.
    void refine(const Settings& settings, const ParticleScan& scan, const Work& work, RefinedPose& pose) const;
    /// The density's update at a known pose, after pairUp; `drawn` makes no difference to it. Returns the log of the
    /// scan's likelihood given the map before, up to what is the same for all particles.
    double update(const Settings& settings, const Vector3& pose, bool drawn, const ParticleScan& scan, Work& work,
                  std::vector<SightRecord>& records);

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
    void correct(const Settings& settings, const Vector3& pose, int view, Work& work) const;
    void begin(const Settings& settings, const Vector3& pose, int view, Work& work) const;
    void write(const Settings& settings, const Vector3& pose, int view, Work& work);
    void leaveBehind(const Settings& settings, const Vector2& position, Work& work);

    SharedPages<PhdFeature> features_;
    int swept_ = 0;  ///< page to be looked through next for what was left behind
};

}  // namespace slamot

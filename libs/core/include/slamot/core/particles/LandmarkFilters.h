#pragma once
// One particle's map as Gaussians of single landmarks, independent given the particle's path: FastSLAM's map
// (paper 2, eq. 12 to 18; paper 4, eq. 24 to 31). Landmarks are known by the identity the log gives or by
// association in each particle; those without identity exist with a probability.
#include <vector>

#include "slamot/core/association/AssociationProblem.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/core/data/Estimate.h"
#include "slamot/core/objects/Existence.h"
#include "slamot/core/particles/ParticleScan.h"
#include "slamot/core/particles/PointSight.h"
#include "slamot/core/particles/SharedPages.h"

namespace slamot {

enum class ParticleAssociation {
    known,      ///< by the log's identity; detections without one are ignored
    nearest,    ///< else the smallest NIS within the gate
    likelihood  ///< else the likeliest, where that is likelier than something new or false
};

struct LandmarkFilterParameters {
    ParticleAssociation association = ParticleAssociation::likelihood;
    double gate_probability = 0.999;
    /// A detection within this gate of a landmark that is not seen otherwise starts no new one.
    double separation_probability = 1 - 1e-6;
    LifeParameters life;
    double max_unseen = 5;  ///< [s]; one that is not confirmed and not seen for longer is let go
};

/// Tables `[name.association]` and `[name.landmarks]`.
std::vector<ParameterTable> describe(LandmarkFilterParameters& parameters, const std::string& name);

struct LandmarkFilter {
    LandmarkId id;
    GaussianPoint point;
    SourceId source;
    Existence existence = Existence::certain();
    std::int64_t seen = 1;
    Stamp first_seen, last_seen;
    Stamp looked;  ///< when its existence was judged last

    double existenceProbability() const { return existence.probability(); }
};

class LandmarkFilters {
  public:
    using Place = SharedPages<LandmarkFilter>::Place;
    /// Nothing is so hidden that a detection could not be its own.
    static constexpr double least_visible = 1e-3;
    /// What all particles' maps have in common.
    struct Settings {
        Settings(const LandmarkFilterParameters& parameters, GaussianTransform transform);
        LandmarkFilterParameters parameters;
        GaussianTransform transform;
        double gate, separation_gate;  ///< of the NIS
    };
    /// Room for one update, used again for the next particle.
    struct Work {
        struct Near {
            Place place;
            GaussianPoint point;
            bool named_now, named;  ///< by a detection of this batch; ever
        };
        std::vector<SensorPlace> places;   ///< of the sensors, by view
        std::vector<Near> near;            ///< what may be in view
        std::vector<int> near_of;          ///< by sight: what it is of, -1 none
        std::vector<PointSight> expected;  ///< by sight, at the predicted pose
        std::vector<bool> may_start;       ///< by sight
        std::vector<LandmarkId> begun;  ///< by sight that may start: of what another sensor has just started
        std::vector<bool> paired;       ///< by view and near: a nameless sight of that view is of it
        /// What else sights may be of, filled by who knows of movers before each pairUp, in the order of
        /// sights, with the movers' own numbers. A sight that is likelier one of theirs is left to them.
        std::vector<Candidate> of_movers;
        std::vector<Candidate> candidates, wide;
        std::vector<PointSight> sights;  ///< by view and near, at the predicted pose, once looked for
        std::vector<bool> has_sight;     ///< by view and near
        std::vector<Place> lost;

        std::size_t pairOf(int view, int n) const { return static_cast<std::size_t>(view) * near.size() + n; }
        const SensorPlace& placeOf(const ScanSight& sight) const {
            return places[static_cast<std::size_t>(sight.view)];
        }
    };

    void renew(std::uint64_t owner) { landmarks_.renew(owner); }

    /// Finds which sight is of which landmark, at the predicted pose; fills `records` by sight.
    void pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan, Work& work,
                std::vector<SightRecord>& records) const;
    /// The pose with what landmarks that exist beyond doubt say of it, sight after sight.
    void refine(const Settings& settings, const ParticleScan& scan, const Work& work,
                RefinedPose& pose) const;
    /// Takes the scan in at a known pose; `drawn`: it is not the one that pairs were found at. Returns the
    /// log of its likelihood given the map before.
    double update(const Settings& settings, const Vector3& pose, bool drawn, const ParticleScan& scan,
                  Work& work, std::vector<SightRecord>& records);

    /// A landmark that all particles are given at once; its number lies above all others'.
    void add(const LandmarkFilter& landmark) { landmarks_.append(landmark); }
    void remove(LandmarkId id);

    const LandmarkFilter* find(LandmarkId id) const { return landmarks_.find(id); }
    static bool isConfirmed(const Settings& settings, const LandmarkFilter& landmark) {
        return landmark.existence.confirmed(settings.parameters.life);
    }
    template <class Visit>
    void forEachConfirmed(const Settings& settings, const Visit& visit) const {
        landmarks_.forEach([&](const LandmarkFilter& landmark) {
            if (isConfirmed(settings, landmark)) visit(landmark);
        });
    }
    const SharedPages<LandmarkFilter>& features() const { return landmarks_; }

  private:
    static const PointSight& expectedAt(const Settings& settings, const PoseBelief& pose,
                                        const ParticleScan& scan, int view, int n, Work& work);
    void findNear(const Vector2& position, const ParticleScan& scan, Work& work) const;
    void pairNamed(const ParticleScan& scan, Work& work) const;
    void pairNameless(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                      Work& work) const;
    double detected(const Settings& settings, const PointSight& expected, const ScanSight& sight,
                    const ParticleScan& scan, Place place);
    double startNew(const Settings& settings, const ParticleScan& scan, Work& work,
                    std::vector<SightRecord>& records);
    /// Which sights of a view are of what the views before it have just started, one of each at most.
    void pairWithBegun(const Settings& settings, const ParticleScan& scan, int view, Work& work) const;
    double missed(const Settings& settings, const ParticleScan& scan, Work& work);
    void start(const Settings& settings, const SensorPlace& sensor, const ScanSight& sight, Stamp now);
    void letGo(const Settings& settings, Stamp now, Work& work);

    SharedPages<LandmarkFilter> landmarks_;
};

}  // namespace slamot

#include "slamot/core/particles/LandmarksAndTargets.h"

#include <cmath>

namespace slamot {

void LandmarksAndTargets::pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                                 Work& work, std::vector<SightRecord>& records) const {
    findRivals(settings, pose, scan, work);
    landmarks_.pairUp(settings.landmarks, pose, scan, work, records);
}

void LandmarksAndTargets::findRivals(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                                     Work& work) const {
    work.rivals.clear();
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        if (!sight.may_be_mover) continue;
        for (std::size_t t = 0; t < targets_.size(); ++t) {
            const PointSight expected =
                sightOf(targets_[t].position(), pose, scan.sensorOf(sight), settings.landmarks.transform);
            const PointInnovation innovation(expected, sight.z, sight.R);
            if (innovation.nis > settings.landmarks.gate) continue;
            // Scores as the landmarks' method has them.
            Candidate pair{static_cast<int>(s), static_cast<int>(t), innovation.nis, -0.5 * innovation.nis};
            if (settings.landmarks.parameters.association == ParticleAssociation::likelihood)
                pair.log_likelihood = innovation.logLikelihood() + std::log(settings.target_detection_probability);
            work.rivals.push_back(pair);
        }
    }
}

}  // namespace slamot

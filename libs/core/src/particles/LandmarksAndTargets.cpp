#include "slamot/core/particles/LandmarksAndTargets.h"

#include <algorithm>
#include <cmath>

namespace slamot {

void LandmarksAndTargets::pairUp(const Settings& settings, const PoseBelief& pose, const ParticleScan& scan,
                                 Work& work, std::vector<SightRecord>& records) const {
    findSightsOfMovers(settings, pose, scan, work);
    landmarks_.pairUp(settings.landmarks, pose, scan, work, records);
}

void LandmarksAndTargets::findSightsOfMovers(const Settings& settings, const PoseBelief& pose,
                                             const ParticleScan& scan, Work& work) const {
    work.of_movers.clear();
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
            if (settings.landmarks.parameters.association == ParticleAssociation::likelihood) {
                pair.log_likelihood =
                    innovation.logLikelihood() + std::log(settings.target_detection_probability);
                if (pair.log_likelihood <= sight.log_unexplained) continue;
                pair.log_likelihood +=
                    std::log(std::max(scan.visible_movers[t], LandmarkFilters::least_visible));
            }
            work.of_movers.push_back(pair);
        }
    }
}

void LandmarksAndTargets::remember(const Vector3& pose, const ParticleScan& scan) {
    if (!scan.fixes_poses && std::none_of(scan.sights.begin(), scan.sights.end(),
                                          [](const ScanSight& s) { return s.may_be_mover; }))
        return;
    // As many as an object keeps sights; sights that are older, since others were seen in between, are left
    // out.
    if (path_.size() == TentativeObject::most_sights) path_.erase(path_.begin());
    path_.push_back({scan.now, pose});
}

GaussianPoint LandmarksAndTargets::pointOf(const Settings& settings,
                                           const std::vector<TentativeSight>& sights, double gate,
                                           double& log_likelihood) const {
    const GaussianTransform transform = settings.landmarks.transform;
    const double detection_probability = settings.landmarks.parameters.life.detection_probability;
    GaussianPoint point;
    bool is_first = true;
    for (const TentativeSight& sight : sights) {
        const auto from = std::find_if(path_.begin(), path_.end(),
                                       [&](const PastPose& past) { return past.at == sight.at; });
        if (from == path_.end()) continue;
        const SensorPlace place = placeOf(from->pose, sight.sensor);
        if (is_first) {
            point = firstSight(place, sight.detection.z(), sight.detection.covariance, transform);
            is_first = false;
            continue;
        }
        const PointSight expected = sightOf(point, place, transform);
        const PointInnovation innovation(expected, sight.detection.z(), sight.detection.covariance);
        // Where the sight was of something else, the landmark was missed.
        double likelihood = (1 - detection_probability) * sight.unexplained;
        if (innovation.nis <= gate) {
            slamot::update(point, expected, innovation);
            likelihood += detection_probability * std::exp(innovation.logLikelihood());
        }
        log_likelihood += std::log(likelihood);
    }
    return point;
}

}  // namespace slamot

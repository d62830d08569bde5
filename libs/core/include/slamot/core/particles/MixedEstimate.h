#pragma once
// What particles say together: moments over those that agree on what they see.
#include <vector>

#include "slamot/core/data/Estimate.h"
#include "slamot/core/particles/ParticleScan.h"
#include "slamot/core/particles/ParticleWeights.h"
#include "slamot/core/particles/PointSight.h"

namespace slamot {

/// One innovation for each detection, with its number and kind.
UpdateReport emptyReport(const RangeBearingSet& seen);

/// Puts into the report what the particle `best` made of each sight. Residual and S are the first two moments of the
/// expected detection over all particles that took it for the same, weighted as before the scan.
void fillReport(const ParticleScan& scan, const ParticleWeights& before, int best,
                const std::vector<std::vector<SightRecord>>& records, UpdateReport& report);

/// Moments of a Gaussian mixture of points whose weights need not sum to 1.
class FeatureMixture {
  public:
    void add(double weight, const GaussianPoint& point);
    GaussianPoint moments() const;

  private:
    double weight_ = 0;
    Vector2 centre_ = Vector2::Zero(), shift_ = Vector2::Zero();
    Matrix2 second_ = Matrix2::Zero();
};

/// As plugins tell it, of a feature with id, source, seen, stamps and existence.
template <class Feature>
LandmarkEstimate landmarkEstimate(const Feature& feature, const GaussianPoint& moments) {
    return {feature.id,         feature.source,    moments.mean,
            moments.covariance, feature.seen,      feature.first_seen,
            feature.last_seen,  feature.existenceProbability(), 0.0};
}

}  // namespace slamot

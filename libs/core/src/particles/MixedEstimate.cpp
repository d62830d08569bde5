#include "slamot/core/particles/MixedEstimate.h"

#include <Eigen/Cholesky>

#include "slamot/core/models/RangeBearing.h"

namespace slamot {

UpdateReport emptyReport(const RangeBearingSet& seen) {
    UpdateReport report;
    report.innovations.resize(seen.detections.size());
    for (std::size_t i = 0; i < report.innovations.size(); ++i) {
        report.innovations[i].detection = static_cast<int>(i);
        report.innovations[i].kind = seen.detections[i].kind;
    }
    return report;
}

void fillReport(const ParticleScan& scan, const ParticleWeights& before, int best,
                const std::vector<std::vector<SightRecord>>& records, UpdateReport& report) {
    const std::vector<SightRecord>& told = records[static_cast<std::size_t>(best)];
    for (std::size_t s = 0; s < scan.sights.size(); ++s) {
        const ScanSight& sight = scan.sights[s];
        const SightRecord& record = told[s];
        Innovation& innovation = report.innovations[static_cast<std::size_t>(sight.detection)];
        innovation.outcome = record.outcome;
        innovation.landmark = record.landmark;
        if (record.outcome != Outcome::updated) continue;

        // Residuals are small beside a turn: their moments are those of expected detections.
        double weight = 0;
        Vector2 mean = Vector2::Zero();
        Matrix2 second = Matrix2::Zero();
        for (std::size_t i = 0; i < records.size(); ++i) {
            const SightRecord& same = records[i][s];
            if (same.outcome != record.outcome || same.landmark != record.landmark)
                continue;
            const double w = before[static_cast<int>(i)];
            const Vector2 nu = rangeBearingResidual(sight.z, same.z);
            weight += w;
            mean += w * nu;
            second += w * (same.S + nu * nu.transpose());
        }
        if (!(weight > 0)) continue;
        innovation.kind = ObjectKind::landmark;
        innovation.residual = mean / weight;
        innovation.covariance = second / weight - innovation.residual * innovation.residual.transpose();
        innovation.nis = innovation.residual.dot(innovation.covariance.llt().solve(innovation.residual));
    }
}

void FeatureMixture::add(double weight, const GaussianPoint& point) {
    if (weight_ == 0) centre_ = point.mean;
    const Vector2 d = point.mean - centre_;
    weight_ += weight;
    shift_ += weight * d;
    second_ += weight * (point.covariance + d * d.transpose());
}

GaussianPoint FeatureMixture::moments() const {
    const Vector2 shift = shift_ / weight_;
    return {centre_ + shift, second_ / weight_ - shift * shift.transpose()};
}

}  // namespace slamot

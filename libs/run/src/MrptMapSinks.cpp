// map.landmarks.gz and correlation.bin.
#include <mrpt/maps/CLandmarksMap.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/GzFile.h"
#include "slamot/rawlog/PartFile.h"
#include "slamot/run/MrptSinks.h"

namespace slamot::run {

void LandmarkMapSink::end(const RunEnd& end) {
    mrpt::maps::CLandmarksMap map;
    for (const LandmarkEstimate& l : end.landmarks) {
        mrpt::maps::CLandmark landmark;
        landmark.createOneFeature();
        landmark.features[0].type = mrpt::vision::featBeacon;
        landmark.pose_mean = {l.mean.x(), l.mean.y(), 0};
        landmark.pose_cov_11 = static_cast<float>(l.covariance(0, 0));
        landmark.pose_cov_12 = static_cast<float>(l.covariance(0, 1));
        landmark.pose_cov_22 = static_cast<float>(l.covariance(1, 1));
        landmark.ID = l.source.valid() ? l.source.value : l.id.value;
        landmark.timestampLastSeen = toMrpt(l.last_seen);
        landmark.seenTimesCount = static_cast<std::uint32_t>(l.seen);
        map.landmarks.push_back(landmark);
    }
    writeGzFile(map, folder_ + "/map.landmarks.gz");
}

void CorrelationSink::end(const RunEnd& end) {
    if (!end.estimator) return;
    const Eigen::MatrixXd P = end.estimator->jointCovariance().matrix;
    if (P.size() == 0) return;
    constexpr Eigen::Index largest = 512;
    const Eigen::Index n = P.rows(), rows = std::min(n, largest);
    std::vector<float> cells(static_cast<std::size_t>(rows * rows), 0.0f);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) {
            const double scale = std::sqrt(P(i, i) * P(j, j));
            const auto value = static_cast<float>(scale > 0 ? P(i, j) / scale : 0.0);
            float& cell = cells[static_cast<std::size_t>((i * rows / n) * rows + j * rows / n)];
            if (std::abs(value) > std::abs(cell)) cell = value;
        }
    PartFile file(folder_ + "/correlation.bin");
    const std::uint32_t header[] = {1, static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(rows)};
    file.write("SLAMCORR");
    file.write({reinterpret_cast<const char*>(header), sizeof header});
    file.write({reinterpret_cast<const char*>(cells.data()), cells.size() * sizeof(float)});
    file.close();
}

}  // namespace slamot::run

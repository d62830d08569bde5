// Identities of trees from iSAM's version of the dataset: a pose graph without times, made with another
// detector of trees. Its poses are the scans, found again by the way between them; its landmark observations
// become labels of the detections at the same place.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "VictoriaPark.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::victoria_park {
namespace {

/// iSAM's odometry and ours are the same integral; its six digits and other rules of integration stay below
/// this [m], [rad].
constexpr double same_way = 3e-4;

/// Pose of the last odometry at or before each scan.
std::vector<std::pair<Stamp, Pose2>> posesOfScans(const ImportedLog& log) {
    std::set<Stamp> stamps(log.empty_scans.begin(), log.empty_scans.end());
    for (const auto& d : log.detections) stamps.insert(d.stamp);
    std::vector<std::pair<Stamp, Pose2>> poses;
    std::size_t next = 0;
    for (const Stamp stamp : stamps) {
        while (next < log.odometry.size() && log.odometry[next].stamp <= stamp) ++next;
        poses.emplace_back(stamp, next == 0 ? Pose2{} : log.odometry[next - 1].pose);
    }
    return poses;
}

/// The next scans that are `way` apart, from `first` on: the index of the later of the two.
std::size_t scanAfter(const Pose2& way, std::size_t first, const std::vector<std::pair<Stamp, Pose2>>& scans,
                      const ColumnRow& row) {
    for (std::size_t i = first; i + 1 < scans.size(); ++i) {
        const Pose2 ours = inverse(scans[i].second) * scans[i + 1].second;
        if (std::abs(ours.x - way.x) < same_way &&
            std::abs(angleDifference(ours.theta, way.theta)) < same_way)
            return i + 1;
        // Scans from a car that stands are not in the graph; moving ones all are.
        if (ours.position().norm() > 10 * same_way) break;
    }
    row.fail(3, fmt::format("the way from one scan to the next after t = {}", toText(scans[first].first)));
}

}  // namespace

LabelCounts labelFromIsam(const std::filesystem::path& file, ImportedLog& log) {
    const auto scans = posesOfScans(log);
    std::map<Stamp, std::vector<ImportedLog::Detection*>> at;
    for (auto& d : log.detections) at[d.stamp].push_back(&d);

    LabelCounts counts;
    std::map<std::int64_t, std::size_t> scan_of_pose;
    std::size_t scan = 0;
    forEachRow(file, 7, dataset, [&](const ColumnRow& row) {
        if (row.text(0) == "ODOMETRY") {
            scan = scanAfter({row.number(3), row.number(4), row.number(5)}, scan, scans, row);
            scan_of_pose.emplace(row.integer(1), scan - 1);
            scan_of_pose[row.integer(2)] = scan;
        } else if (row.text(0) == "LANDMARK") {
            const auto pose = scan_of_pose.find(row.integer(1));
            if (pose == scan_of_pose.end())
                row.fail(1, "a pose that an ODOMETRY row before this one leads to");
            const Vector2 place(row.number(3), row.number(4));
            ++counts.total;
            ImportedLog::Detection* nearest = nullptr;
            double least = label_distance;
            for (ImportedLog::Detection* d : at[scans[pose->second].first]) {
                const Vector2 seen =
                    laser * Vector2(d->range * std::cos(d->bearing), d->range * std::sin(d->bearing));
                if (d->id.valid() || (seen - place).norm() >= least) continue;
                least = (seen - place).norm();
                nearest = d;
            }
            if (!nearest) return;
            nearest->id = SourceId{row.integer(2)};
            ++counts.found;
        } else {
            row.fail(0, "ODOMETRY or LANDMARK");
        }
    });
    return counts;
}

}  // namespace slamot::victoria_park

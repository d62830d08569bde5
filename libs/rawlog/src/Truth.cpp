#include "slamot/rawlog/Truth.h"

#include <algorithm>
#include <filesystem>

namespace slamot {
namespace {

/// The neighbours of a stamp in samples of rising stamps, and how far it lies from the first to the second.
struct Neighbours {
    std::size_t before, after;
    double fraction;
};

template <class Sample>
std::optional<Neighbours> neighbours(const std::vector<Sample>& samples, Stamp stamp, double max_gap) {
    const auto after = std::lower_bound(samples.begin(), samples.end(), stamp,
                                        [](const Sample& sample, Stamp t) { return sample.stamp < t; });
    if (after == samples.end()) return std::nullopt;
    const auto i = static_cast<std::size_t>(after - samples.begin());
    if (after->stamp == stamp) return Neighbours{i, i, 0};
    if (i == 0) return std::nullopt;
    const double gap = secondsBetween(samples[i - 1].stamp, samples[i].stamp);
    if (gap > max_gap) return std::nullopt;
    return Neighbours{i - 1, i, secondsBetween(samples[i - 1].stamp, stamp) / gap};
}

}  // namespace

std::optional<Pose2> Truth::pointAt(Stamp stamp) const {
    const auto n = neighbours(robot, stamp, max_interpolation_gap);
    if (!n) return std::nullopt;
    const Pose2 &a = robot[n->before].pose, &b = robot[n->after].pose;
    const double f = n->fraction;
    return Pose2{a.x + f * (b.x - a.x), a.y + f * (b.y - a.y),
                 wrapAngle(a.theta + f * angleDifference(b.theta, a.theta))};
}

std::optional<Pose2> Truth::robotAt(Stamp stamp) const {
    const auto at_point = pointAt(stamp);
    if (!at_point || point.isZero(0)) return at_point;
    return *at_point * inverse(Pose2{point.x(), point.y(), 0});
}

std::optional<TrueTarget> Truth::targetAt(SourceId id, Stamp stamp) const {
    const auto found = targets.find(id);
    if (found == targets.end()) return std::nullopt;
    const auto n = neighbours(found->second, stamp, max_interpolation_gap);
    if (!n) return std::nullopt;
    const TrueTarget &a = found->second[n->before], &b = found->second[n->after];
    const auto between = [f = n->fraction](const Vector2& u, const Vector2& v) -> Vector2 {
        return u + f * (v - u);
    };
    TrueTarget target{stamp, between(a.position, b.position), between(a.velocity, b.velocity),
                      between(a.acceleration, b.acceleration), a.mode};
    if (!target.position.allFinite()) return std::nullopt;
    return target;
}

std::string truthFolderOf(const std::string& log_file) {
    return std::filesystem::path(log_file).replace_extension(".truth").string();
}

}  // namespace slamot

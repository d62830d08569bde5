// What the replay shows of doubt: particles, and what may be a landmark.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sections/ReplayColumns.h"
#include "sections/ReplayScene.h"
#include "slamot/core/particles/ParticleWeights.h"

namespace slamot::report {
namespace {

using nlohmann::json;

constexpr std::size_t most_dots = 100000;
constexpr int weight_levels = 9;

/// Something that may be a landmark, while it looks the same.
struct TentativeSpan {
    std::size_t from, to;
    LandmarkSight sight;
};

bool looksLike(const LandmarkSight& a, const LandmarkSight& b, double pixel) {
    return (a.mean - b.mean).norm() <= pixel && std::abs(a.existence - b.existence) <= visible_existence;
}

/// The entries of `all`, which rise, that have a frame's stamp: visit(frame, entry).
template <class Entry, class Visit>
void forEachOfFrames(const std::vector<Stamp>& stamps, const std::vector<Entry>& all, const Visit& visit) {
    auto next = all.begin();
    for (std::size_t f = 0; f < stamps.size(); ++f) {
        next = std::find_if(next, all.end(), [&](const Entry& entry) { return !(entry.stamp < stamps[f]); });
        for (; next != all.end() && next->stamp == stamps[f]; ++next) {
            visit(f, *next);
        }
    }
}

std::vector<TentativeSpan> spansOf(const std::vector<Stamp>& stamps, const std::vector<LandmarkSight>& all,
                                   double pixel) {
    std::vector<TentativeSpan> spans;
    std::map<LandmarkId, std::size_t> latest;
    forEachOfFrames(stamps, all, [&](std::size_t frame, const LandmarkSight& sight) {
        const auto before = sight.id.valid() ? latest.find(sight.id) : latest.end();
        if (before != latest.end() && spans[before->second].to == frame &&
            looksLike(spans[before->second].sight, sight, pixel)) {
            ++spans[before->second].to;
            return;
        }
        latest[sight.id] = spans.size();
        spans.push_back({frame, frame + 1, sight});
    });
    return spans;
}

}  // namespace

void ReplayScene::makeTentative() {
    std::vector<TentativeSpan> spans = spansOf(stamps_, run.tentative, pixel_ / 2);
    if (spans.size() > most_places) {
        cuts_.push_back(
            fmt::format("Of {} places of what may be a landmark the {} of highest existence are drawn.",
                        spans.size(), most_places));
        std::stable_sort(spans.begin(), spans.end(), [](const TentativeSpan& a, const TentativeSpan& b) {
            return a.sight.existence > b.sight.existence;
        });
        spans.resize(most_places);
    }
    ReplayColumns columns(digits_);
    for (const TentativeSpan& span : spans) {
        columns.whole("from", static_cast<std::int64_t>(span.from));
        columns.whole("to", static_cast<std::int64_t>(span.to));
        columns.point(span.sight.mean);
        columns.whole("existence", std::llround(100 * span.sight.existence));
    }
    tentative_ = spans.empty() ? json() : columns.take();
}

void ReplayScene::makeParticles() {
    if (run.particles.empty()) {
        return;
    }
    const double unit = std::pow(10, -digits_);
    const int most = static_cast<int>(std::max<std::size_t>(1, most_dots / frames_.size()));
    ReplayColumns columns(digits_);
    std::vector<std::size_t> counts(frames_.size(), 0);
    std::size_t thinned_of = 0;
    forEachOfFrames(stamps_, run.particles, [&](std::size_t frame, const ParticleSet& set) {
        std::vector<double> weights;
        for (const ParticleSet::Row& row : set.rows) {
            weights.push_back(row.weight);
        }
        const std::vector<KeptParticle> kept = thinned(weights, most);
        double heaviest = std::numeric_limits<double>::min();
        for (const KeptParticle& particle : kept) {
            heaviest = std::max(heaviest, particle.weight);
        }
        const Vector2 robot = run.run.trajectory[frames_[frame]].robot.mean.position();
        for (const auto& [index, weight] : kept) {
            const Pose2& pose = set.rows[index].pose;
            columns.whole("x", std::llround((pose.x - robot.x()) / unit));
            columns.whole("y", std::llround((pose.y - robot.y()) / unit));
            columns.whole("theta", std::llround(100 * pose.theta));
            columns.whole("weight", std::llround(weight_levels * weight / heaviest));
        }
        counts[frame] = kept.size();
        thinned_of = std::max(thinned_of, set.rows.size());
    });
    if (thinned_of > static_cast<std::size_t>(most)) {
        cuts_.push_back(fmt::format("Of {} particles {} are drawn, chosen by weight.", thinned_of, most));
    }
    particles_ = std::move(columns.take());
    particles_["unit"] = unit;
    particles_["first"] = {0};
    std::size_t first = 0;
    for (const std::size_t count : counts) {
        particles_["first"].push_back(first += count);
    }
}

}  // namespace slamot::report

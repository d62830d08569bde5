// How landmarks come closer to their true places.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <map>

#include "MetricRows.h"
#include "sections/Courses.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace {

constexpr double nearest_within = 2;  // [m], as [eval] landmark_cutoff's default
constexpr std::size_t sample_count = 300;

/// The true landmark of each estimated one: by source id, without one the nearest to its last place.
std::map<LandmarkId, Vector2> truthOfLandmarks(const RunFolder& run, bool& by_place) {
    std::map<LandmarkId, const LandmarkSight*> last;
    for (const LandmarkSight& sight : run.sights) {
        last[sight.id] = &sight;
    }
    std::map<LandmarkId, Vector2> places;
    by_place = false;
    for (const auto& [id, sight] : last) {
        if (sight->source.valid()) {
            const auto truth = run.truth->landmarks.find(sight->source);
            if (truth != run.truth->landmarks.end()) {
                places[id] = truth->second;
            }
            continue;
        }
        double nearest = nearest_within;
        for (const auto& [source, place] : run.truth->landmarks) {
            if (const double distance = (place - sight->mean).norm(); distance < nearest) {
                nearest = distance;
                places[id] = place;
                by_place = true;
            }
        }
    }
    return places;
}

std::string absent(const RunFolder& run) {
    return !run.truth                     ? "no truth: " + run.why_no_truth
           : run.truth->landmarks.empty() ? "truth knows no landmark"
           : run.sights.empty() ? "landmarks_history.csv is not there or empty ([output] landmarks_history)"
                                : "";
}

/// Quantiles over the landmarks known so far, each as it was when last seen.
struct Quantiles {
    Band middle{"10 % to 90 % of the landmarks", {}, colour::green, 0.25};
    Line median{"median error", {}, colour::green, 1.8};
    Line bound{"median of 3σ along the widest axis", {}, colour::grey, 1.3, Dash::dashed};
};

Quantiles quantilesOf(const RunFolder& run, const std::map<LandmarkId, Vector2>& places) {
    Quantiles result;
    struct State {
        double error = 0, bound = 0;
    };
    std::map<LandmarkId, State> known;
    const Windows windows(run, sample_count);
    std::size_t next = 0;
    for (std::size_t w = 0; w < sample_count; ++w) {
        while (next < run.sights.size() && windows.of(run.sights[next].stamp) <= w) {
            const LandmarkSight& sight = run.sights[next++];
            if (const auto place = places.find(sight.id); place != places.end()) {
                const double half = sight.covariance.trace() / 2;
                const double widest =
                    half + std::sqrt(std::max(0.0, half * half - sight.covariance.determinant()));
                known[sight.id] = {(sight.mean - place->second).norm(), 3 * std::sqrt(widest)};
            }
        }
        std::vector<double> errors, bounds;
        for (const auto& [id, state] : known) {
            errors.push_back(state.error);
            bounds.push_back(state.bound);
        }
        const double t = windows.begin(w + 1);
        result.middle.rows.push_back({t, quantile(errors, 0.1), quantile(errors, 0.9)});
        result.median.points.emplace_back(t, quantile(errors, 0.5));
        result.bound.points.emplace_back(t, quantile(bounds, 0.5));
    }
    return result;
}

std::vector<Block> blocks(const RunFolder& run) {
    bool by_place = false;
    const std::map<LandmarkId, Vector2> places = truthOfLandmarks(run, by_place);
    const Quantiles quantiles = quantilesOf(run, places);
    Panel panel;
    panel.x = runTimeAxis(run);
    panel.y.label = "Distance from the true place";
    panel.y.unit = "m";
    panel.y.min = 0;
    panel.layers = {quantiles.middle, quantiles.bound, quantiles.median};
    Figure figure;
    figure.panels = {panel};
    std::string caption = fmt::format("{} landmarks with a truth; at the end the median error is {} m.",
                                      places.size(), shortNumber(quantiles.median.points.back().y()));
    if (by_place) {
        caption += fmt::format(
            " Landmarks without a source id are compared with the nearest true one within {} m of "
            "their last place.",
            nearest_within);
    }
    return {PageFigure{"landmark_errors", "Error of the landmarks over time. " + caption, figure, caption}};
}

}  // namespace

const ReportSection landmark_error_section{
    "landmark-errors", "Landmark errors",
    "Over the landmarks known at a time, each as it was when last seen by then.", absent, blocks};

}  // namespace slamot::report

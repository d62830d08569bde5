// How landmarks come closer to their true places.
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "MetricRows.h"
#include "sections/Courses.h"
#include "sections/Sections.h"

namespace slamot::report {
namespace section_landmark_errors {

constexpr std::size_t sample_count = 300;

struct TrueLandmark {
    SourceId id;
    Vector2 place;
    bool by_place = false;  ///< no source id says so
};

/// The true landmark of each estimated one: by source id, without one the nearest to its last place.
std::map<LandmarkId, TrueLandmark> truthOfLandmarks(const RunFolder& run) {
    std::map<LandmarkId, const LandmarkSight*> last;
    for (const LandmarkSight& sight : run.sights) {
        last[sight.id] = &sight;
    }
    std::map<LandmarkId, TrueLandmark> result;
    for (const auto& [id, sight] : last) {
        if (sight->source.valid()) {
            const auto truth = run.truth->landmarks.find(sight->source);
            if (truth != run.truth->landmarks.end()) {
                result[id] = {sight->source, truth->second, false};
            }
            continue;
        }
        double nearest = run.evaluation.landmark_cutoff;
        for (const auto& [source, place] : run.truth->landmarks) {
            if (const double distance = (place - sight->mean).norm(); distance <= nearest) {
                nearest = distance;
                result[id] = {source, place, true};
            }
        }
    }
    return result;
}

std::string absent(const RunFolder& run) {
    if (!run.truth) {
        return "no truth: " + run.why_no_truth;
    }
    return run.truth->landmarks.empty() ? "truth knows no landmark"
           : run.sights.empty() ? "landmarks_history.csv is not there or empty ([output] landmarks_history)"
           : truthOfLandmarks(run).empty()
               ? fmt::format("no landmark has a true one by its source id or within {} m of its last place",
                             run.evaluation.landmark_cutoff)
               : "";
}

/// The map as the history tells it: each landmark as it was when last seen.
class KnownMap {
  public:
    KnownMap(const RunFolder& run, const std::map<LandmarkId, TrueLandmark>& truths)
        : run_(run), truths_(truths) {
        for (const LandmarkEstimate& landmark : run.run.landmarks) {
            kept_.insert(landmark.id);
        }
        for (const LandmarkSight& sight : run.sights) {
            last_[sight.id] = sight.stamp;
        }
    }

    void take(const LandmarkSight& sight) {
        const auto truth = truths_.find(sight.id);
        if (truth == truths_.end()) {
            return;
        }
        State& state = states_[truth->second.id][sight.id];
        state.error = (sight.mean - truth->second.place).norm();
        const double half = sight.covariance.trace() / 2;
        const double widest = half + std::sqrt(std::max(0.0, half * half - sight.covariance.determinant()));
        state.bound = 3 * std::sqrt(std::max(0.0, widest));
        ++state.seen;
        // Files do not say when a landmark left the map, so it goes after it was last seen.
        if (run_.map_known && kept_.count(sight.id) == 0 && last_.at(sight.id) == sight.stamp) {
            gone_.emplace_back(truth->second.id, sight.id);
        }
    }

    void removeGone() {
        for (const auto& [truth, estimate] : gone_) {
            states_[truth].erase(estimate);
        }
        gone_.clear();
    }

    /// Of several estimates of one true landmark the one seen most, of equals the one of lowest id.
    void errorsAndBounds(std::vector<double>& errors, std::vector<double>& bounds) const {
        for (const auto& [id, estimates] : states_) {
            const auto best =
                std::max_element(estimates.begin(), estimates.end(),
                                 [](const auto& a, const auto& b) { return a.second.seen < b.second.seen; });
            if (best != estimates.end()) {
                errors.push_back(best->second.error);
                bounds.push_back(best->second.bound);
            }
        }
    }

  private:
    struct State {
        double error = 0, bound = 0;
        int seen = 0;
    };
    const RunFolder& run_;
    const std::map<LandmarkId, TrueLandmark>& truths_;
    std::set<LandmarkId> kept_;
    std::map<LandmarkId, Stamp> last_;
    std::map<SourceId, std::map<LandmarkId, State>> states_;
    std::vector<std::pair<SourceId, LandmarkId>> gone_;
};

/// Quantiles over the true landmarks that the map knows at a time.
struct Quantiles {
    Band middle{"10 % to 90 % of the landmarks", {}, colour::green, 0.25};
    Line median{"median error", {}, colour::green, 1.8};
    Line bound{"median of 3σ along the widest axis", {}, colour::grey, 1.3, Dash::dashed};
    std::size_t at_end = 0;
};

Quantiles quantilesOf(const RunFolder& run, const std::map<LandmarkId, TrueLandmark>& truths) {
    Quantiles result;
    KnownMap map(run, truths);
    const Windows windows(run, sample_count);
    std::size_t next = 0;
    for (std::size_t w = 0; w < sample_count; ++w) {
        while (next < run.sights.size() && windows.of(run.sights[next].stamp) <= w) {
            map.take(run.sights[next++]);
        }
        if (w + 1 == sample_count) {
            map.removeGone();  // the map at the end is known
        }
        std::vector<double> errors, bounds;
        map.errorsAndBounds(errors, bounds);
        map.removeGone();
        const double t = windows.begin(w + 1);
        result.middle.rows.push_back({t, quantile(errors, 0.1), quantile(errors, 0.9)});
        result.median.points.emplace_back(t, quantile(errors, 0.5));
        result.bound.points.emplace_back(t, quantile(bounds, 0.5));
        result.at_end = errors.size();
    }
    return result;
}

std::string captionOf(const RunFolder& run, const std::map<LandmarkId, TrueLandmark>& truths,
                      const Quantiles& quantiles) {
    std::string caption =
        quantiles.at_end == 0
            ? "No landmark with a truth is in the map at the end."
            : fmt::format(
                  "{} true landmarks are in the map at the end; the median error of their estimates when "
                  "last seen is {} m.",
                  quantiles.at_end, shortNumber(quantiles.median.points.back().y()));
    if (std::any_of(truths.begin(), truths.end(), [](const auto& t) { return t.second.by_place; })) {
        caption += fmt::format(
            " Landmarks without a source id are compared with the nearest true one within {} m of "
            "their last place.",
            run.evaluation.landmark_cutoff);
    }
    return caption;
}

std::vector<Block> blocks(const RunFolder& run) {
    const std::map<LandmarkId, TrueLandmark> truths = truthOfLandmarks(run);
    const Quantiles quantiles = quantilesOf(run, truths);
    Panel panel;
    panel.x = runTimeAxis(run);
    panel.y.label = "Distance from the true place";
    panel.y.unit = "m";
    panel.y.min = 0;
    panel.layers = {quantiles.middle, quantiles.bound, quantiles.median};
    Figure figure;
    figure.panels = {panel};
    const std::string caption = captionOf(run, truths, quantiles);
    return {PageFigure{"landmark_errors", "Error of the landmarks over time. " + caption, figure, caption}};
}

}  // namespace section_landmark_errors

const ReportSection landmark_error_section{
    "landmark-errors", "Landmark errors",
    "Over the true landmarks in the map at a time, each as its estimate was when last seen by then; of "
    "several "
    "estimates the one seen most. What is not in the map at the end counts until it was last seen.",
    section_landmark_errors::absent, section_landmark_errors::blocks};

}  // namespace slamot::report

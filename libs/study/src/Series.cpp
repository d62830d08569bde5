#include "slamot/study/Series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "slamot/core/data/Angle.h"
#include "slamot/eval/Metrics.h"

namespace slamot::study {
namespace {

const std::string mode_prefix = "p_";
const std::string error_by_age = "landmark_error_by_age";

bool isMode(const std::string& name) {
    return name.rfind(mode_prefix, 0) == 0 && name.size() > mode_prefix.size();
}

/// Appends values to a series, in seconds since the run's start.
class Appender {
  public:
    Appender(Series& series, Stamp start) : series_(series), start_(start) {}
    void add(Stamp stamp, double value) { addAfter(secondsBetween(start_, stamp), value); }
    void addAfter(double seconds, double value) {
        series_.seconds.push_back(seconds);
        series_.value.push_back(value);
    }
    void add(Stamp stamp, const eval::SquaredError& squared) {
        add(stamp, squared.value);
        series_.dimension.push_back(squared.dimension);
    }

  private:
    Series& series_;
    Stamp start_;
};

const TrackEstimate* trackOf(SourceId target, const std::vector<TrackEstimate>& tracks) {
    const auto less_likely = [](const TrackEstimate& a, const TrackEstimate& b) {
        return a.existence < b.existence;
    };
    const bool any_source =
        std::any_of(tracks.begin(), tracks.end(), [](const TrackEstimate& t) { return t.source.value >= 0; });
    if (!any_source) {
        const auto found = std::max_element(tracks.begin(), tracks.end(), less_likely);
        return found == tracks.end() ? nullptr : &*found;
    }
    const TrackEstimate* best = nullptr;
    for (const TrackEstimate& track : tracks)
        if (track.source == target && (!best || less_likely(*best, track))) best = &track;
    return best;
}

/// What series are made from.
struct SeriesInput {
    const eval::RunRecord& record;
    const LandmarkHistory& landmarks;
    const Truth* truth;
    std::vector<eval::PosePair> pairs;  ///< of trajectory and truth
    SourceId target;                    ///< of lowest id; 0 where truth has none
};

void robotNees(const SeriesInput& run, Appender& out) {
    for (const eval::NeesStep& step : eval::robotNees(run.pairs)) out.add(step.stamp, step.squared);
}

void robotError(const SeriesInput& run, Appender& out) {
    for (const eval::PosePair& pair : run.pairs)
        out.add(pair.stamp,
                std::hypot(pair.estimate.mean.x - pair.truth.x, pair.estimate.mean.y - pair.truth.y));
}

void headingError(const SeriesInput& run, Appender& out) {
    for (const eval::PosePair& pair : run.pairs)
        out.add(pair.stamp, angleDifference(pair.estimate.mean.theta, pair.truth.theta));
}

/// Hands (stamp, track, position's error) of the target to `add` wherever it has both.
template <class Add>
void forTarget(const SeriesInput& run, Add add) {
    for (const auto& [stamp, tracks] : run.record.tracks) {
        const TrackEstimate* track = trackOf(run.target, tracks);
        const auto true_target = run.truth->targetAt(run.target, stamp);
        if (track && true_target) add(stamp, *track, track->mean.head<2>() - true_target->position);
    }
}

void targetError(const SeriesInput& run, Appender& out) {
    forTarget(run,
              [&](Stamp stamp, const TrackEstimate&, const Vector2& error) { out.add(stamp, error.norm()); });
}

void targetNees(const SeriesInput& run, Appender& out) {
    forTarget(run, [&](Stamp stamp, const TrackEstimate& track, const Vector2& error) {
        out.add(stamp, eval::nees(error, track.covariance.topLeftCorner<2, 2>()));
    });
}

void landmarkCount(const SeriesInput& run, Appender& out) {
    for (const eval::RobotRow& row : run.record.trajectory)
        if (const auto found = run.landmarks.counts().find(row.stamp); found != run.landmarks.counts().end())
            out.add(row.stamp, static_cast<double>(found->second));
}

void landmarkErrorByAge(const SeriesInput& run, Appender& out) {
    std::map<double, std::pair<double, int>> squares;  // sum and count, by age
    for (const auto& [stamp, landmark] : run.landmarks.sights()) {
        const auto place = run.truth->landmarks.find(landmark.source);
        if (place == run.truth->landmarks.end()) continue;
        auto& [sum, count] = squares[secondsBetween(landmark.first_seen, stamp)];
        sum += (landmark.mean - place->second).squaredNorm();
        ++count;
    }
    for (const auto& [age, square] : squares) out.addAfter(age, std::sqrt(square.first / square.second));
}

void modeProbability(std::size_t mode, const SeriesInput& run, Appender& out) {
    for (const auto& [stamp, tracks] : run.record.tracks) {
        const TrackEstimate* track = trackOf(run.target, tracks);
        if (track && mode < track->mode_probabilities.size()) out.add(stamp, track->mode_probabilities[mode]);
    }
}

enum class Needs { nothing, truth, true_target };

struct SeriesKind {
    const char* name;
    Needs needs;
    bool is_nees;  ///< has dimensions
    void (*fill)(const SeriesInput&, Appender&);
};

/// All but the probabilities of modes, whose names are the estimator's.
const std::array<SeriesKind, 7> kinds = {{
    {"robot_nees", Needs::truth, true, robotNees},
    {"robot_error", Needs::truth, false, robotError},
    {"heading_error", Needs::truth, false, headingError},
    {"target_error", Needs::true_target, false, targetError},
    {"target_nees", Needs::true_target, true, targetNees},
    {"landmark_count", Needs::nothing, false, landmarkCount},
    {error_by_age.c_str(), Needs::truth, false, landmarkErrorByAge},
}};

/// Null for one that is not in the table.
const SeriesKind* kindOf(const std::string& name) {
    const auto found =
        std::find_if(kinds.begin(), kinds.end(), [&](const SeriesKind& kind) { return kind.name == name; });
    return found == kinds.end() ? nullptr : &*found;
}

bool has(const SeriesInput& run, Needs needs) {
    switch (needs) {
        case Needs::nothing:
            return true;
        case Needs::truth:
            return run.truth != nullptr;
        case Needs::true_target:
            return run.truth && !run.truth->targets.empty();
    }
    return false;
}

}  // namespace

void requireKnownSeries(const std::vector<std::string>& names, const std::string& origin) {
    std::vector<std::string> known;
    for (const SeriesKind& kind : kinds) known.push_back(kind.name);
    for (const std::string& name : names) {
        if (isMode(name) || kindOf(name)) continue;
        const auto near = nearestWord(name, known);
        throw ConfigError(fmt::format("{}: no series '{}'{}, expected {} or p_<mode>", origin, name,
                                      near ? " (did you mean '" + *near + "'?)" : "",
                                      fmt::join(known, ", ")));
    }
}

bool isNeesSeries(const std::string& name) {
    const SeriesKind* kind = kindOf(name);
    return kind && kind->is_nees;
}

LandmarkHistory::LandmarkHistory(const std::vector<std::string>& series)
    : keeps_sights_(std::find(series.begin(), series.end(), error_by_age) != series.end()) {}

void LandmarkHistory::step(const run::Step& step) {
    counts_[step.estimate.stamp] = step.estimate.landmark_count;
    if (keeps_sights_)
        for (const LandmarkEstimate& landmark : step.touched)
            sights_.push_back({step.estimate.stamp, landmark});
}

std::map<std::string, Series> seriesOf(const std::vector<std::string>& names, const eval::RunRecord& record,
                                       const LandmarkHistory& landmarks, const Truth* truth) {
    std::map<std::string, Series> all;
    if (names.empty() || record.trajectory.empty()) return all;
    SeriesInput run{record, landmarks, truth, {}, SourceId{0}};
    if (truth) run.pairs = eval::pairWithTruth(record.trajectory, *truth).pairs;
    if (has(run, Needs::true_target)) run.target = truth->targets.begin()->first;

    const Stamp start = record.trajectory.front().stamp;
    for (const std::string& name : names) {
        Series series;
        Appender out(series, start);
        if (const SeriesKind* kind = kindOf(name)) {
            if (!has(run, kind->needs)) continue;
            kind->fill(run, out);
        } else {
            const auto& modes = record.mode_names;
            const auto mode = std::find(modes.begin(), modes.end(), name.substr(mode_prefix.size()));
            if (!isMode(name) || mode == modes.end()) continue;
            modeProbability(static_cast<std::size_t>(mode - modes.begin()), run, out);
        }
        all[name] = std::move(series);
    }
    return all;
}

}  // namespace slamot::study

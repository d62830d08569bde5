#include "slamot/study/Series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "slamot/core/data/Angle.h"
#include "slamot/eval/Metrics.h"

namespace slamot::study {
namespace {

const std::vector<std::string> fixed_names = {"robot_nees",   "robot_error", "heading_error",
                                              "target_error", "target_nees", "landmark_count"};
const std::string mode_prefix = "p_";

bool isMode(const std::string& name) {
    return name.rfind(mode_prefix, 0) == 0 && name.size() > mode_prefix.size();
}

/// Appends values to a series, in seconds since the run's start.
class Appender {
  public:
    Appender(Series& series, Stamp start) : series_(series), start_(start) {}
    void add(Stamp stamp, double value) {
        series_.seconds.push_back(secondsBetween(start_, stamp));
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

Series robotSeries(const std::string& name, const eval::RunRecord& record, const Truth& truth, Stamp start) {
    Series series;
    Appender out(series, start);
    const eval::PairedTrajectory paired = eval::pairWithTruth(record.trajectory, truth);
    if (name == "robot_nees")
        for (const eval::NeesStep& step : eval::robotNees(paired.pairs)) out.add(step.stamp, step.squared);
    else
        for (const eval::PosePair& pair : paired.pairs) {
            const Pose2& mean = pair.estimate.mean;
            if (name == "robot_error")
                out.add(pair.stamp, std::hypot(mean.x - pair.truth.x, mean.y - pair.truth.y));
            else
                out.add(pair.stamp, angleDifference(mean.theta, pair.truth.theta));
        }
    return series;
}

Series targetSeries(const std::string& name, const eval::RunRecord& record, const Truth& truth, Stamp start) {
    Series series;
    Appender out(series, start);
    const SourceId target = truth.targets.begin()->first;
    for (const auto& [stamp, tracks] : record.tracks) {
        const TrackEstimate* track = trackOf(target, tracks);
        const auto true_target = truth.targetAt(target, stamp);
        if (!track || !true_target) continue;
        const Vector2 error = track->mean.head<2>() - true_target->position;
        if (name == "target_error")
            out.add(stamp, error.norm());
        else
            out.add(stamp, eval::nees(error, track->covariance.topLeftCorner<2, 2>()));
    }
    return series;
}

Series modeSeries(std::size_t mode, const eval::RunRecord& record, const Truth* truth, Stamp start) {
    Series series;
    Appender out(series, start);
    const SourceId target = truth && !truth->targets.empty() ? truth->targets.begin()->first : SourceId{0};
    for (const auto& [stamp, tracks] : record.tracks) {
        const TrackEstimate* track = trackOf(target, tracks);
        if (track && mode < track->mode_probabilities.size()) out.add(stamp, track->mode_probabilities[mode]);
    }
    return series;
}

Series countSeries(const eval::RunRecord& record, const std::map<Stamp, std::int64_t>& counts, Stamp start) {
    Series series;
    Appender out(series, start);
    for (const eval::RobotRow& row : record.trajectory)
        if (const auto found = counts.find(row.stamp); found != counts.end())
            out.add(row.stamp, static_cast<double>(found->second));
    return series;
}

}  // namespace

void requireKnownSeries(const std::vector<std::string>& names, const std::string& origin) {
    for (const std::string& name : names) {
        if (isMode(name) || std::find(fixed_names.begin(), fixed_names.end(), name) != fixed_names.end())
            continue;
        const auto near = nearestWord(name, fixed_names);
        throw ConfigError(fmt::format("{}: no series '{}'{}, expected {} or p_<mode>", origin, name,
                                      near ? " (did you mean '" + *near + "'?)" : "",
                                      fmt::join(fixed_names, ", ")));
    }
}

std::map<std::string, Series> seriesOf(const std::vector<std::string>& names, const eval::RunRecord& record,
                                       const std::map<Stamp, std::int64_t>& landmark_counts,
                                       const Truth* truth) {
    std::map<std::string, Series> all;
    if (record.trajectory.empty()) return all;
    const Stamp start = record.trajectory.front().stamp;
    for (const std::string& name : names) {
        if (isMode(name)) {
            const auto& modes = record.mode_names;
            const auto mode = std::find(modes.begin(), modes.end(), name.substr(mode_prefix.size()));
            if (mode != modes.end())
                all[name] = modeSeries(static_cast<std::size_t>(mode - modes.begin()), record, truth, start);
        } else if (name == "landmark_count") {
            all[name] = countSeries(record, landmark_counts, start);
        } else if (truth && name.rfind("target_", 0) == 0) {
            if (!truth->targets.empty()) all[name] = targetSeries(name, record, *truth, start);
        } else if (truth) {
            all[name] = robotSeries(name, record, *truth, start);
        }
    }
    return all;
}

}  // namespace slamot::study

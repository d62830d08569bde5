#include "slamot/eval/Association.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace slamot::eval {
namespace {

/// A true landmark or mover; their ids are separate spaces.
using Source = std::pair<bool, SourceId>;  // is a mover, id
/// An estimated landmark or track, likewise.
using Object = std::pair<bool, std::int64_t>;  // is a track, id

/// One detection: where it came from (nothing: clutter) and where it went (nothing: nowhere, or not decided).
struct Sorted {
    std::optional<Source> source;
    std::optional<Object> object;
    bool tentative = false;
};

std::optional<Object> objectOf(const Innovation& innovation) {
    const bool taken = innovation.outcome == Outcome::updated || innovation.outcome == Outcome::inflated ||
                       innovation.outcome == Outcome::initiated;
    if (!taken) return std::nullopt;
    if (innovation.track.valid()) return Object{true, innovation.track.value};
    if (innovation.landmark.valid()) return Object{false, innovation.landmark.value};
    return std::nullopt;
}

std::map<Stamp, std::map<int, const TrueAssociation*>> byStamp(
    const std::vector<TrueAssociation>& associations) {
    std::map<Stamp, std::map<int, const TrueAssociation*>> result;
    for (const TrueAssociation& a : associations) result[a.stamp][a.index] = &a;
    return result;
}

using Rows = std::vector<InnovationRow>::const_iterator;

/// What truth says of the detections of one stamp: one per row, null where it says nothing. Counts what is
/// not known.
std::vector<const TrueAssociation*> originsAt(Rows first, Rows last,
                                              const std::map<int, const TrueAssociation*>& at_stamp,
                                              AssociationMetrics& counts) {
    static const TrueAssociation added_clutter{{}, -1, "clutter", {}};
    const auto rows = static_cast<int>(last - first);
    std::vector<const TrueAssociation*> origins(static_cast<std::size_t>(rows), nullptr);
    // Files that do not tell a detection's number in the log tell it among those that the run took in: where
    // these are fewer, the two countings differ.
    const int in_log = first->log ? first->log->count : rows;
    if (!at_stamp.empty() && at_stamp.rbegin()->first >= in_log) {
        counts.unnumbered += rows;
        return origins;
    }
    for (int i = 0; i < rows; ++i) {
        const InnovationRow& row = first[i];
        const int detection = row.innovation.detection;
        const int number = row.log ? row.log->number : detection >= 0 ? detection : i;
        if (const auto found = at_stamp.find(number); found != at_stamp.end())
            origins[static_cast<std::size_t>(i)] = found->second;
        else if (row.log && number < 0)
            origins[static_cast<std::size_t>(i)] = &added_clutter;
    }
    const auto unknown = std::count(origins.begin(), origins.end(), nullptr);
    // Where truth knows but a part of the log's detections, all of the added clutter would outweigh them.
    if (unknown > 0)
        for (const TrueAssociation*& origin : origins)
            if (origin == &added_clutter) origin = nullptr;
    counts.without_truth += std::count(origins.begin(), origins.end(), nullptr);
    return origins;
}

/// The detections of the run that truth knows, in order of time.
std::vector<Sorted> sortDetections(const RunRecord& run, const Truth& truth, AssociationMetrics& counts) {
    auto true_sources = byStamp(truth.associations);
    std::vector<Sorted> detections;
    for (auto first = run.innovations.begin(); first != run.innovations.end();) {
        const auto last = std::find_if(first, run.innovations.end(),
                                       [&](const InnovationRow& row) { return row.stamp != first->stamp; });
        for (const TrueAssociation* origin : originsAt(first, last, true_sources[first->stamp], counts)) {
            const Innovation& innovation = (first++)->innovation;
            if (!origin) continue;
            Sorted sorted{std::nullopt, objectOf(innovation), innovation.outcome == Outcome::tentative};
            if (origin->kind != "clutter") sorted.source = Source{origin->kind == "mover", origin->id};
            detections.push_back(sorted);
        }
    }
    counts.used = static_cast<std::int64_t>(detections.size());
    return detections;
}

/// How often two things came together, and which of the pairs was the first.
struct Tally {
    std::int64_t count = 0;
    std::size_t first = 0;
    bool operator>(const Tally& other) const {
        return count != other.count ? count > other.count : first < other.first;
    }
};

template <class Key, class Value>
std::map<Key, Value> mostFrequent(const std::map<Key, std::map<Value, Tally>>& tallies) {
    std::map<Key, Value> result;
    for (const auto& [key, values] : tallies)
        result.emplace(key, std::max_element(values.begin(), values.end(), [](const auto& a, const auto& b) {
                                return b.second > a.second;
                            })->first);
    return result;
}

void add(AssociationScores& scores, const AssociationScores& more) {
    scores.detections += more.detections;
    scores.found += more.found;
    scores.tentative += more.tentative;
    scores.associated += more.associated;
    scores.right += more.right;
    scores.clutter += more.clutter;
}

void divide(AssociationScores& scores) {
    const auto part = [](std::int64_t of, std::int64_t whole, double& result) {
        if (whole > 0) result = static_cast<double>(of) / static_cast<double>(whole);
    };
    part(scores.found, scores.detections, scores.recall);
    part(scores.right, scores.associated, scores.precision);
}

std::int64_t doubledIn(const std::vector<LandmarkEstimate>& map, const std::map<Object, Source>& stands_for) {
    std::set<Source> met;
    std::int64_t doubled = 0;
    for (const LandmarkEstimate& landmark : map) {
        const auto source = stands_for.find(Object{false, landmark.id.value});
        if (source != stands_for.end()) doubled += !met.insert(source->second).second;
    }
    return doubled;
}

}  // namespace

Measured<AssociationMetrics> associationMetrics(const RunRecord& run, const Truth& truth) {
    using Result = Measured<AssociationMetrics>;
    if (truth.associations.empty()) return Result::absent("truth has no associations");
    if (run.innovations.empty()) return Result::absent("the run has no innovations");
    AssociationMetrics metrics;
    const std::vector<Sorted> detections = sortDetections(run, truth, metrics);
    if (detections.empty())
        return Result::absent(
            metrics.unnumbered > 0
                ? "the log had fewer detections than truth has at every stamp, so that their "
                  "numbers do not fit"
                : "truth has no association of any detection of the run");

    std::map<Object, std::map<Source, Tally>> sources_of;
    std::map<Source, std::map<Object, Tally>> objects_of;
    for (std::size_t i = 0; i < detections.size(); ++i) {
        const auto& [source, object, tentative] = detections[i];
        if (!source || !object) continue;
        ++sources_of[*object].try_emplace(*source, Tally{0, i}).first->second.count;
    }
    const std::map<Object, Source> stands_for = mostFrequent(sources_of);
    for (const auto& [object, source] : stands_for) objects_of[source][object] = sources_of[object][source];
    const std::map<Source, Object> object_of = mostFrequent(objects_of);

    std::set<Source> in_estimate;  // what some object stands for by then
    for (const auto& [source, object, tentative] : detections) {
        // A detection of what the estimate has already is a miss, whatever else it was kept for.
        if (tentative && !(source && in_estimate.count(*source) > 0)) {
            ++(!source         ? metrics.tentative_clutter
               : source->first ? metrics.movers.tentative
                               : metrics.landmarks.tentative);
            continue;
        }
        if (source) {
            AssociationScores& scores = source->first ? metrics.movers : metrics.landmarks;
            const auto expected = object_of.find(*source);
            ++scores.detections;
            scores.found += object && expected != object_of.end() && expected->second == *object;
            if (object && stands_for.at(*object) == *source) in_estimate.insert(*source);
        }
        if (object) {
            AssociationScores& scores = object->first ? metrics.movers : metrics.landmarks;
            const auto meant = stands_for.find(*object);
            ++scores.associated;
            scores.clutter += !source;
            scores.right += source && meant != stands_for.end() && meant->second == *source;
        }
    }
    metrics.doubled_landmarks = doubledIn(run.landmarks, stands_for);
    add(metrics.all, metrics.landmarks);
    add(metrics.all, metrics.movers);
    for (AssociationScores* scores : {&metrics.all, &metrics.landmarks, &metrics.movers}) divide(*scores);
    return metrics;
}

}  // namespace slamot::eval

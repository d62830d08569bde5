#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "slamot/eval/Metrics.h"

namespace slamot::eval {
namespace {

using Json = nlohmann::json;

/// JSON has no NaN: a number that does not exist is null.
Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json json(const ErrorSummary& e) {
    return {{"count", e.count},           {"rmse", number(e.rmse)},       {"mean", number(e.mean)},
            {"median", number(e.median)}, {"maximum", number(e.maximum)}, {"final", number(e.final)}};
}

Json json(const NeesSummary& n) {
    return {{"steps", n.steps},
            {"without_variance", n.without_variance},
            {"reduced", n.reduced},
            {"mean_dimension", n.mean_dimension},
            {"average", number(n.average)},
            {"median", number(n.median)},
            {"band", {n.band.low, n.band.high}},
            {"inside", n.inside},
            {"coverage", n.coverage}};
}

Json json(const RobotErrors& r) {
    return {{"position", json(r.position)}, {"x", json(r.x)}, {"y", json(r.y)}, {"heading", json(r.heading)}};
}

Json json(const AbsoluteError& a) {
    return {{"alignment", toText(a.alignment)},
            {"T_truth_estimate", {a.T_truth_estimate.x, a.T_truth_estimate.y, a.T_truth_estimate.theta}},
            {"position", json(a.position)},
            {"heading", json(a.heading)}};
}

Json json(const RelativeError& r) {
    return {{"delta", r.delta},
            {"unit", toText(r.unit)},
            {"mean_delta", r.mean_delta},
            {"position", json(r.position)},
            {"heading", json(r.heading)}};
}

Json json(const std::vector<NisGroup>& groups) {
    Json list = Json::array();
    for (const NisGroup& g : groups) {
        Json outcomes = Json::object();
        for (const auto& [outcome, count] : g.outcomes) outcomes[slamot::toText(outcome)] = count;
        list.push_back({{"sensor", g.sensor},
                        {"kind", slamot::toText(g.kind)},
                        {"outcomes", outcomes},
                        {"count", g.count},
                        {"mean_per_degree", number(g.mean_per_degree)},
                        {"median_per_degree", number(g.median_per_degree)},
                        {"inside", number(g.inside)},
                        {"coverage", number(g.coverage)}});
    }
    return list;
}

Json json(const SetDistance& d) {
    return {{"ospa",
             {{"total", d.ospa.total},
              {"localisation", d.ospa.localisation},
              {"cardinality", d.ospa.cardinality}}},
            {"gospa",
             {{"total", d.gospa.total},
              {"localisation_part", d.gospa.localisation_part},
              {"missed_part", d.gospa.missed_part},
              {"false_part", d.gospa.false_part},
              {"matched_count", d.gospa.matched_count},
              {"missed_count", d.gospa.missed_count},
              {"false_count", d.gospa.false_count}}}};
}

Json json(const TrackSetDistance& t) {
    Json result = json(t.mean);
    result["stamps"] = t.stamps;
    result["stamps_in_gaps"] = t.stamps_in_gaps;
    return result;
}

Json json(const AssociationScores& s) {
    return {{"recall", number(s.recall)}, {"precision", number(s.precision)}, {"detections", s.detections},
            {"found", s.found},           {"associated", s.associated},       {"right", s.right},
            {"clutter", s.clutter},       {"tentative", s.tentative}};
}

Json json(const AssociationMetrics& a) {
    return {{"all", json(a.all)},
            {"landmarks", json(a.landmarks)},
            {"movers", json(a.movers)},
            {"used", a.used},
            {"without_truth", a.without_truth},
            {"unnumbered", a.unnumbered},
            {"tentative_clutter", a.tentative_clutter},
            {"doubled_landmarks", a.doubled_landmarks}};
}

Json json(const TrackingMetrics& t) {
    const ClearMot& c = t.clear;
    const IdentityScores& i = t.identity;
    const TrajectoryDistance& d = t.trajectories;
    return {{"stamps", t.stamps},
            {"stamps_in_gaps", t.stamps_in_gaps},
            {"set_aside", t.set_aside},
            {"mota", number(c.mota)},
            {"motp", number(c.motp)},
            {"target_stamps", c.target_stamps},
            {"matched", c.matched},
            {"misses", c.misses},
            {"false_positives", c.false_positives},
            {"switches", c.switches},
            {"fragmentations", c.fragmentations},
            {"mostly_tracked", c.mostly_tracked},
            {"partly_tracked", c.partly_tracked},
            {"mostly_lost", c.mostly_lost},
            {"idf1", number(i.idf1)},
            {"idp", number(i.precision)},
            {"idr", number(i.recall)},
            {"id_true_positives", i.true_positives},
            {"id_false_positives", i.false_positives},
            {"id_false_negatives", i.false_negatives},
            {"cardinality",
             {{"error", t.cardinality.mean},
              {"absolute_error", t.cardinality.mean_absolute},
              {"targets", t.cardinality.mean_targets},
              {"tracks", t.cardinality.mean_tracks}}},
            {"tgospa",
             {{"total", d.total},
              {"lower_bound", d.lower_bound},
              {"per_stamp", d.per_stamp},
              {"localisation_part", d.localisation_part},
              {"missed_part", d.missed_part},
              {"false_part", d.false_part},
              {"switch_part", d.switch_part},
              {"switches", d.switches}}}};
}

Json json(const MapCardinality::Seen& s) {
    return {{"landmarks", s.landmarks}, {"error", s.error}, {"absolute_error", std::abs(s.error)}};
}

/// Puts the metric at `place`[`name`], or the reason at `absent`[`path`].
template <class T>
void put(Json& place, const std::string& name, const Measured<T>& metric, Json& absent,
         const std::string& path) {
    if (metric)
        place[name] = json(*metric);
    else
        absent[path] = metric.whyAbsent();
}

Json json(const TargetErrors& t, Json& absent, const std::string& path) {
    Json result = {{"position", json(t.position)},
                   {"velocity", json(t.velocity)},
                   {"relative_position", json(t.relative_position)},
                   {"relative_velocity", json(t.relative_velocity)}};
    put(result, "nees", t.nees, absent, path + ".nees");
    return result;
}

Json json(const TargetMetrics& t, Json& absent) {
    Json result = {{"matched", t.matched},
                   {"without_source", t.without_source},
                   {"without_truth", t.without_truth},
                   {"doubled", t.doubled},
                   {"missed", t.missed},
                   {"all", json(t.all, absent, "targets.all")}};
    if (t.seen)
        result["seen"] = json(*t.seen, absent, "targets.seen");
    else
        absent["targets.seen"] = t.seen.whyAbsent();
    for (const auto& [id, errors] : t.by_target) {
        const std::string name = std::to_string(id.value);
        result["by_target"][name] = json(errors, absent, "targets.by_target." + name);
    }
    return result;
}

Json json(const MapCardinality& m, Json& absent) {
    Json result = {{"estimated", m.estimated},
                   {"landmarks", m.landmarks},
                   {"error", m.error},
                   {"absolute_error", std::abs(m.error)}};
    put(result, "seen", m.seen, absent, "map_cardinality.seen");
    return result;
}

Json json(const LandmarkErrors& l, Json& absent) {
    Json result = {{"matching", toText(l.matching)},
                   {"matched", l.matched},
                   {"missing", l.missing},
                   {"extra", l.extra},
                   {"position", json(l.position)}};
    put(result, "nees", l.nees, absent, "landmarks.nees");
    return result;
}

}  // namespace

nlohmann::json toJson(const Metrics& m) {
    Json result, absent = Json::object();
    EvaluationOptions options = m.options;
    const ParameterTable table = describe(options);
    for (const Parameter& parameter : table.parameters())
        result["options"][parameter.key] = parameter.print();
    result["matching"] = {
        {"total", m.matching.total}, {"covered", m.matching.covered}, {"matched", m.matching.matched}};
    put(result, "robot", m.robot, absent, "robot");
    put(result, "ate", m.ate, absent, "ate");
    put(result, "rpe", m.rpe, absent, "rpe");
    put(result, "robot_nees", m.robot_nees, absent, "robot_nees");
    put(result, "nis", m.nis, absent, "nis");
    put(result, "landmark_set", m.landmark_set, absent, "landmark_set");
    put(result, "track_set", m.track_set, absent, "track_set");
    put(result, "association", m.association, absent, "association");
    put(result["tracking"], "all", m.tracking, absent, "tracking.all");
    put(result["tracking"], "seen", m.tracking_seen, absent, "tracking.seen");
    if (result["tracking"].is_null()) result.erase("tracking");
    if (m.map_cardinality)
        result["map_cardinality"] = json(*m.map_cardinality, absent);
    else
        absent["map_cardinality"] = m.map_cardinality.whyAbsent();
    if (m.landmarks)
        result["landmarks"] = json(*m.landmarks, absent);
    else
        absent["landmarks"] = m.landmarks.whyAbsent();
    if (m.targets)
        result["targets"] = json(*m.targets, absent);
    else
        absent["targets"] = m.targets.whyAbsent();
    result["absent"] = absent;
    return result;
}

}  // namespace slamot::eval

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "../config/TextParts.h"
#include "slamot/core/filter/JointFilter.h"

namespace slamot {
namespace {

const std::string schedule_expected =
    "'none' or time:model[:noise_std] entries separated by commas, in rising time, e.g. 15:ca:1.8";

std::string scheduleText(const std::vector<ModelChange>& schedule) {
    std::string text;
    for (const ModelChange& change : schedule)
        text += fmt::format("{}{}:{}:{}", text.empty() ? "" : ", ", shortestText(change.after),
                            toText(change.kind), shortestText(change.noise_std));
    return text.empty() ? "none" : text;
}

/// Reads a schedule; an entry without a noise has ModelChange's.
std::optional<std::vector<ModelChange>> scheduleFromText(const std::string& text) {
    std::vector<ModelChange> schedule;
    if (text == "none" || text.empty()) return schedule;
    if (text.back() == ',') return std::nullopt;
    for (const std::string& entry : splitAt(text, ',')) {
        const auto parts = splitAt(entry, ':');
        if (parts.size() < 2 || parts.size() > 3) return std::nullopt;
        TargetModel model;
        model.noise_std = ModelChange{}.noise_std;
        ParameterTable keys("schedule", "");
        describe(model, keys);
        const auto after = numberFromText(parts[0]);
        if (!after || !std::isfinite(*after) || *after < 0 ||
            (!schedule.empty() && *after <= schedule.back().after))
            return std::nullopt;
        if (keys.find("model")->parse(parts[1])) return std::nullopt;
        if (parts.size() == 3 && keys.find("noise_std")->parse(parts[2])) return std::nullopt;
        schedule.push_back({*after, model.kind, model.noise_std});
    }
    return schedule;
}

ParameterTable filterTable(JointFilterParameters& p, const std::string& name, const std::string& about) {
    ParameterTable filter(name, about);
    filter
        .choice("consistency", p.consistency,
                {{"invariant", Consistency::invariant}, {"classic", Consistency::classic}},
                "invariant: covariance transported along updates, second-order range terms; classic: the "
                "textbook "
                "EKF, which grows over-confident.")
        .choice(
            "engine", p.engine.kind,
            {{"dense", JointEngine::Kind::dense}, {"compressed", JointEngine::Kind::compressed}},
            "dense: one covariance, a step costs the square of the map; compressed: the same numbers, a step "
            "costs what is near the sensors, and small maps are kept as in dense.");
    return filter;
}

ParameterTable outlierTable(JointFilterParameters& p, const std::string& name) {
    ParameterTable outliers(name + ".outliers", "What happens to detections whose innovation is unlikely.");
    outliers
        .choice("treatment", p.outliers,
                {{"inflate", OutlierTreatment::inflate},
                 {"reject", OutlierTreatment::reject},
                 {"accept", OutlierTreatment::accept}},
                "inflate: noise times (NIS / gate)^2; reject: not used; accept: used as if nothing were odd.")
        .real("gate_probability", p.gate_probability, "-", Interval::openProbability(),
              "Part of good detections that lie inside the gate.");
    return outliers;
}

void describeLife(JointFilterParameters& p, ParameterTable& target) {
    target
        .real("velocity_std", p.target_velocity_std, "m/s", Interval::positive(),
              "Prior of each velocity component at first sight.")
        .real("acceleration_std", p.target_acceleration_std, "m/s^2", Interval::nonNegative(),
              "Prior of each acceleration component at first sight.")
        .real("max_unseen", p.target_max_unseen, "s", Interval::positiveOrInfinite(),
              "A track not seen for longer ends; inf keeps it.")
        .real("position_floor", p.target_position_floor, "m", Interval::nonNegative(),
              "Standard deviation below which no mover's position falls: an over-confident track is lost.");
}

}  // namespace

std::vector<ParameterTable> describe(JointFilterParameters& p, const std::string& name,
                                     const std::string& about) {
    ParameterTable target(name + ".target", "Motion and life of movers.");
    describe(p.target, target);
    target.custom({"schedule", "s", schedule_expected,
                   "Changes of the model at known times since the start, for all movers: a filter that is "
                   "told the mode.",
                   [&p](const std::string& text) -> std::optional<std::string> {
                       auto schedule = scheduleFromText(text);
                       if (!schedule) return schedule_expected;
                       p.target_schedule = std::move(*schedule);
                       return std::nullopt;
                   },
                   [&p] { return scheduleText(p.target_schedule); }});
    describeLife(p, target);
    ParameterTable landmarks(name + ".landmarks", "Life of landmarks without an identity.");
    describeLandmarks(p.life, landmarks);
    describeMovers(p.life, target);
    return {filterTable(p, name, about),
            describe(p.engine.active_set, name + ".engine"),
            outlierTable(p, name),
            describe(p.association, name + ".association"),
            landmarks,
            target,
            describeMixed(p.life, name)};
}

std::vector<ParameterTable> describeImm(JointFilterParameters& p, const std::string& name,
                                        const std::string& about) {
    ParameterTable filter = filterTable(p, name, about);
    filter
        .choice("likelihood", p.imm.likelihood,
                {{"conditional", ModeLikelihood::conditional}, {"marginal", ModeLikelihood::marginal}},
                "What makes a mode likely: the mover's innovation given the landmarks' of the same batch, or "
                "alone.")
        .choice("form", p.imm.form,
                {{"auto", ImmForm::automatic},
                 {"exact", ImmForm::exact},
                 {"scalable", ImmForm::scalable},
                 {"decoupled", ImmForm::decoupled}},
                "exact: a joint Gaussian for each combination of the movers' modes; scalable: one joint "
                "Gaussian and a "
                "bank of modes for each mover; auto: exact up to max_exact_targets, scalable from the next "
                "mover on "
                "until all tracks have ended; decoupled: a baseline that leaves out what joint estimation is "
                "for, robot "
                "and map from landmarks alone and an IMM for each mover that takes the robot's covariance as "
                "noise.")
        .integer("max_exact_targets", p.imm.max_exact_targets, Interval::between(1, 4),
                 "Movers in the exact form at most; where form = exact, further ones are ignored.");
    ParameterTable modes(name + ".modes", "Modes of movers and how movers change between them.");
    describe(p.imm, modes);
    ParameterTable target(name + ".target", "Life of movers.");
    describeLife(p, target);
    ParameterTable landmarks(name + ".landmarks", "Life of landmarks without an identity.");
    describeLandmarks(p.life, landmarks);
    describeMovers(p.life, target);
    return {filter,
            describe(p.engine.active_set, name + ".engine"),
            outlierTable(p, name),
            describe(p.association, name + ".association"),
            landmarks,
            modes,
            target,
            describeMixed(p.life, name)};
}

}  // namespace slamot

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "../config/TextParts.h"
#include "slamot/core/estimation/TargetModes.h"

namespace slamot {
namespace {

const std::string modes_expected =
    "name:model:noise_std[:turn_deg] entries separated by commas, with different names of letters, digits "
    "and _, e.g. "
    "cv:cv:0.5, ca:ca:1.5, left:ct:0.5:20";
const std::string probabilities_expected = "numbers in [0, 1] separated by commas, or auto";

std::string modesText(const std::vector<TargetMode>& modes) {
    std::string text;
    for (const auto& [name, model] : modes) {
        ParameterTable keys("mode", "");
        TargetModel copy = model;
        describe(copy, keys);
        text += fmt::format("{}{}:{}:{}", text.empty() ? "" : ", ", name, toText(model.kind),
                            shortestText(model.noise_std));
        if (model.kind == TargetModelKind::ct) text += ":" + keys.find("turn_rate_deg")->print();
        if (model.kind == TargetModelKind::unicycle) text += ":" + keys.find("turn_rate_std_deg")->print();
    }
    return text;
}

bool isName(const std::string& word) {
    return !word.empty() &&
           std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; });
}

/// One entry; the numbers go through the target model's own keys.
std::optional<TargetMode> modeFromText(const std::string& entry) {
    const auto parts = splitAt(entry, ':');
    if (parts.size() < 3 || parts.size() > 4 || !isName(parts[0])) return std::nullopt;
    TargetMode mode;
    mode.name = parts[0];
    ParameterTable keys("mode", "");
    describe(mode.model, keys);
    if (keys.find("model")->parse(parts[1]) || keys.find("noise_std")->parse(parts[2])) return std::nullopt;
    if (parts.size() == 3) return mode.model.kind == TargetModelKind::ct ? std::nullopt : std::optional(mode);
    const char* turn = mode.model.kind == TargetModelKind::ct         ? "turn_rate_deg"
                       : mode.model.kind == TargetModelKind::unicycle ? "turn_rate_std_deg"
                                                                      : nullptr;
    if (!turn || keys.find(turn)->parse(parts[3])) return std::nullopt;
    return mode;
}

std::optional<std::vector<TargetMode>> modesFromText(const std::string& text) {
    if (text.empty() || text.back() == ',') return std::nullopt;
    std::vector<TargetMode> modes;
    for (const std::string& entry : splitAt(text, ',')) {
        const auto mode = modeFromText(entry);
        if (!mode) return std::nullopt;
        for (const TargetMode& other : modes)
            if (other.name == mode->name) return std::nullopt;
        modes.push_back(*mode);
    }
    return modes;
}

Parameter probabilities(const std::string& key, std::optional<std::vector<double>>& field,
                        const std::string& help) {
    const auto list = [key](std::vector<double>& numbers) {
        ParameterTable table("list", "");
        table.reals(key, numbers, "-", Interval::probability(), "");
        return *table.find(key);
    };
    return {key,
            "-",
            probabilities_expected,
            help,
            [&field, list](const std::string& text) -> std::optional<std::string> {
                std::vector<double> numbers;
                if (text != "auto" && (list(numbers).parse(text) || numbers.empty()))
                    return probabilities_expected;
                field = text == "auto" ? std::nullopt : std::optional(numbers);
                return std::nullopt;
            },
            [&field, list] {
                if (!field) return std::string("auto");
                std::vector<double> numbers = *field;
                return list(numbers).print();
            }};
}

}  // namespace

void describe(ImmParameters& p, ParameterTable& table) {
    table
        .custom({"modes", "m/s^2 (ca: m/s^3), deg/s", modes_expected,
                 "The motions a mover may change between: cv, ca, ct with its turn rate, unicycle with the "
                 "change of its turn rate.",
                 [&p](const std::string& text) -> std::optional<std::string> {
                     auto modes = modesFromText(text);
                     if (!modes) return modes_expected;
                     p.modes = std::move(*modes);
                     return std::nullopt;
                 },
                 [&p] { return modesText(p.modes); }})
        .real("noise_interval", p.noise_interval, "s", Interval::nonNegative(),
              "How long one draw of the driving noise holds; 0: for each prediction step, which makes the "
              "noise "
              "depend on the rate of the odometry.")
        .real("stay_probability", p.stay_probability, "-", Interval::probability(),
              "Probability that a mover keeps its mode; the rest is shared evenly between the others.")
        .custom(probabilities(
            "transition", p.transition,
            "Instead of stay_probability, all transition probabilities row by row: row i holds where "
            "a mover in mode i goes."))
        .real("transition_interval", p.transition_interval, "s", Interval::nonNegative(),
              "Time after which the transition probabilities hold; other lengths of prediction use powers of "
              "the "
              "matrix. 0: they hold for each prediction, whatever its length.")
        .custom(probabilities("initial", p.initial, "Mode probabilities at first sight; auto: all equal."));
}

}  // namespace slamot

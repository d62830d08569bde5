#include "ScenarioText.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

namespace slamot::sim {
namespace {

const std::vector<std::pair<std::string, TargetModelKind>>& modelWords() {
    static const std::vector<std::pair<std::string, TargetModelKind>> words{
        {"cv", TargetModelKind::cv},
        {"ca", TargetModelKind::ca},
        {"ct", TargetModelKind::ct},
        {"unicycle", TargetModelKind::unicycle}};
    return words;
}

std::vector<std::string> splitAt(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::stringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    if (!text.empty() && text.back() == separator) parts.emplace_back();
    return parts;
}

std::vector<std::string> wordsOf(const std::string& text) {
    std::stringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

std::string withoutSpaces(std::string text) {
    text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\t'; }),
               text.end());
    return text;
}

/// Exactly `count` finite numbers.
std::optional<std::vector<double>> numbers(const std::string& text, std::size_t count) {
    std::vector<double> values;
    for (const std::string& part : splitAt(withoutSpaces(text), ',')) {
        const std::optional<double> value = numberFromText(part);
        if (!value || !std::isfinite(*value)) return std::nullopt;
        values.push_back(*value);
    }
    return values.size() == count ? std::optional(values) : std::nullopt;
}

std::optional<Vector2> pointFrom(const std::string& text) {
    const auto v = numbers(text, 2);
    return v ? std::optional(Vector2((*v)[0], (*v)[1])) : std::nullopt;
}

std::string textOf(const Vector2& p) {
    return shortestText(p.x()) + "," + shortestText(p.y());
}

std::optional<Box> boxFrom(const std::string& text) {
    const auto v = numbers(text, 4);
    if (!v || (*v)[0] >= (*v)[1] || (*v)[2] >= (*v)[3]) return std::nullopt;
    return Box{(*v)[0], (*v)[1], (*v)[2], (*v)[3]};
}

std::string textOf(const Box& b) {
    return textOf(Vector2(b.x_min, b.x_max)) + "," + textOf(Vector2(b.y_min, b.y_max));
}

std::optional<SpeedLevel> levelFrom(const std::string& word) {
    const std::vector<std::string> parts = splitAt(word, ':');
    if (parts.size() != 2) return std::nullopt;
    const auto distance = numberFromText(parts[0]), speed = numberFromText(parts[1]);
    if (!distance || !speed || *distance <= 0 || *speed < 0 || !std::isfinite(*speed)) return std::nullopt;
    return SpeedLevel{*distance, *speed};
}

std::string textOf(const SpeedLevel& level) {
    return shortestText(level.distance) + ":" + shortestText(level.speed);
}

std::optional<ScheduleEntry> scheduleEntryFrom(const std::string& word) {
    const std::vector<std::string> parts = splitAt(word, ':');
    if (parts.size() < 2 || parts.size() > 3) return std::nullopt;
    const auto time = numberFromText(parts[0]);
    const auto model = std::find_if(modelWords().begin(), modelWords().end(),
                                    [&](const auto& candidate) { return candidate.first == parts[1]; });
    if (!time || !std::isfinite(*time) || *time < 0 || model == modelWords().end()) return std::nullopt;
    ScheduleEntry entry{*time, model->second, {}};
    if (parts.size() == 3) {
        const auto turn_rate = numberFromText(parts[2]);
        const bool turns = entry.kind == TargetModelKind::ct || entry.kind == TargetModelKind::unicycle;
        if (!turns || !turn_rate || !std::isfinite(*turn_rate)) return std::nullopt;
        entry.turn_rate = radians(*turn_rate);
    }
    return entry;
}

std::string textOf(const ScheduleEntry& entry) {
    std::string text = shortestText(entry.time);
    for (const auto& [word, kind] : modelWords()) {
        if (kind == entry.kind) text += ":" + word;
    }
    return entry.turn_rate ? text + ":" + shortestText(degrees(*entry.turn_rate)) : text;
}

/// A key whose text `read` turns into the field's value, or into nothing when it is not of the expected form.
template <class T>
void addField(ParameterTable& table, const std::string& key, T& field, const std::string& unit,
              const std::string& expected, const std::string& help,
              std::function<std::optional<T>(const std::string&)> read,
              std::function<std::string(const T&)> write) {
    table.custom({key, unit, expected, help,
                  [&field, read, expected](const std::string& text) -> std::optional<std::string> {
                      std::optional<T> value = read(text);
                      if (!value) return expected;
                      field = std::move(*value);
                      return std::nullopt;
                  },
                  [&field, write] { return write(field); }});
}

/// As addField, for a field that may be absent, which `word` says.
template <class T>
void addOptionalField(ParameterTable& table, const std::string& key, std::optional<T>& field,
                      const std::string& unit, const std::string& expected, const std::string& word,
                      const std::string& help, std::optional<T> (*read)(const std::string&)) {
    using Field = std::optional<T>;
    addField<Field>(
        table, key, field, unit, expected + " or " + word, help,
        [read, word](const std::string& text) -> std::optional<Field> {
            if (text == word) return Field{};
            const Field value = read(text);
            return value ? std::optional<Field>(value) : std::nullopt;
        },
        [word](const Field& value) { return value ? textOf(*value) : word; });
}

/// A list of words; the empty list is written as `none`.
template <class T>
void addList(ParameterTable& table, const std::string& key, std::vector<T>& field, const std::string& unit,
             const std::string& expected, const std::string& help,
             std::optional<T> (*read)(const std::string&)) {
    using List = std::vector<T>;
    addField<List>(
        table, key, field, unit, expected + " separated by spaces, or none", help,
        [read](const std::string& text) -> std::optional<List> {
            List list;
            if (text == "none") return list;
            for (const std::string& word : wordsOf(text)) {
                const std::optional<T> value = read(word);
                if (!value) return std::nullopt;
                list.push_back(*value);
            }
            return list.empty() ? std::nullopt : std::optional(list);
        },
        [](const List& list) {
            std::string text;
            for (const T& value : list) text += (text.empty() ? "" : " ") + textOf(value);
            return text.empty() ? "none" : text;
        });
}

constexpr const char* point_form = "x,y";
constexpr const char* box_form = "x_min,x_max,y_min,y_max with min below max";

}  // namespace

std::optional<int> smallNumberFromText(const std::string& text) {
    const bool digits = !text.empty() && text.size() <= 6 &&
                        std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    return digits ? std::optional(std::stoi(text)) : std::nullopt;
}

void addPoint(ParameterTable& table, const std::string& key, Vector2& field, const std::string& unit,
              const std::string& help) {
    addField<Vector2>(table, key, field, unit, point_form, help, pointFrom,
                      [](const Vector2& p) { return textOf(p); });
}

void addPoint(ParameterTable& table, const std::string& key, std::optional<Vector2>& field,
              const std::string& unit, const std::string& help) {
    addOptionalField<Vector2>(table, key, field, unit, point_form, "auto", help, pointFrom);
}

void addBox(ParameterTable& table, const std::string& key, Box& field, const std::string& help) {
    addField<Box>(table, key, field, "m", box_form, help, boxFrom, [](const Box& b) { return textOf(b); });
}

void addBox(ParameterTable& table, const std::string& key, std::optional<Box>& field,
            const std::string& help) {
    addOptionalField<Box>(table, key, field, "m", box_form, "none", help, boxFrom);
}

void addPath(ParameterTable& table, const std::string& key, std::vector<Vector2>& field,
             const std::string& help) {
    addList<Vector2>(table, key, field, "m", "points x,y (no spaces inside)", help, pointFrom);
}

void addLevels(ParameterTable& table, const std::string& key, std::vector<SpeedLevel>& field,
               const std::string& help) {
    addList<SpeedLevel>(table, key, field, "m:m/s", "levels distance:speed", help, levelFrom);
}

void addSchedule(ParameterTable& table, const std::string& key, std::vector<ScheduleEntry>& field,
                 const std::string& help) {
    addList<ScheduleEntry>(table, key, field, "s:model[:deg/s]",
                           "entries time:model or time:ct:turn_rate, with model cv, ca, ct or unicycle,",
                           help, scheduleEntryFrom);
}

void addId(ParameterTable& table, const std::string& key, SourceId& field, const std::string& help) {
    addField<SourceId>(
        table, key, field, "-", "a whole number from 0 to 999999", help,
        [](const std::string& text) -> std::optional<SourceId> {
            const std::optional<int> value = smallNumberFromText(text);
            return value ? std::optional(SourceId{*value}) : std::nullopt;
        },
        [](const SourceId& id) { return std::to_string(id.value); });
}

void addNumbers(ParameterTable& table, const std::string& key, std::vector<int>& field,
                const std::string& help) {
    using List = std::vector<int>;
    addField<List>(
        table, key, field, "-", "whole numbers separated by commas, or all", help,
        [](const std::string& text) -> std::optional<List> {
            List list;
            if (text == "all") return list;
            for (const std::string& part : splitAt(withoutSpaces(text), ',')) {
                const std::optional<int> value = smallNumberFromText(part);
                if (!value) return std::nullopt;
                list.push_back(*value);
            }
            return list.empty() ? std::nullopt : std::optional(list);
        },
        [](const List& list) {
            std::string text;
            for (const int value : list) text += (text.empty() ? "" : ",") + std::to_string(value);
            return text.empty() ? "all" : text;
        });
}

}  // namespace slamot::sim

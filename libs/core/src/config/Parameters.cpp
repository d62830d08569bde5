#include "slamot/core/config/Parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "slamot/core/data/Angle.h"

#include "Text.h"

namespace slamot {
namespace {

bool isDegrees(const std::string& key) {
    return key.size() > 4 && key.compare(key.size() - 4, 4, "_deg") == 0;
}

/// Degrees and radians are both doubles, but not every double in radians is that of a double in degrees. Text
/// with more digits than a double has is therefore read and turned in extended precision.
constexpr int double_digits = 17;
constexpr long double radians_per_degree = pi / 180.0;

int significantDigits(const std::string& text) {
    const std::string mantissa = text.substr(0, text.find_first_of("eE"));
    const auto first = mantissa.find_first_of("123456789");
    if (first == std::string::npos) return 0;
    return static_cast<int>(std::count_if(mantissa.begin() + static_cast<std::ptrdiff_t>(first),
                                          mantissa.end(), [](unsigned char c) { return std::isdigit(c); }));
}

/// `text` in degrees, a number that has been checked, in radians.
double radiansFromText(const std::string& text) {
    if (significantDigits(text) <= double_digits) return radians(*numberFromText(text));
    long double value = 0;
    std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), text.data() + text.size(), value);
    return static_cast<double>(value * radians_per_degree);
}

/// Reads one number of a parameter in file units and gives it in the program's.
std::optional<double> readNumber(const std::string& text, const Interval& interval, bool is_degrees) {
    const std::string word = trimmed(text);
    const auto value = numberFromText(word);
    if (!value || !interval.contains(*value)) return std::nullopt;
    if (std::isinf(*value) && !(interval.infinite && *value > 0)) return std::nullopt;
    return is_degrees ? radiansFromText(word) : *value;
}

/// The shortest text in file units that reads back as exactly `value`.
std::string writeNumber(double value, bool is_degrees) {
    if (!is_degrees || !std::isfinite(value)) return shortestText(value);
    // Degrees are rounded to what a person would write, as long as the radians come back unchanged.
    const long double in_degrees = value / radians_per_degree;
    std::string text;
    for (int digits = 6; digits <= std::numeric_limits<long double>::max_digits10; ++digits) {
        text = fmt::format("{:.{}g}", in_degrees, digits);
        if (radiansFromText(text) == value) break;
    }
    return text;
}

std::string expectedNumber(const Interval& interval, const std::string& unit, const char* what = "a number") {
    std::string text = what;
    if (unit != "-" && !unit.empty()) text += " [" + unit + "]";
    const std::string range = interval.text();
    return range.empty() ? text : text + " " + range;
}

std::string joined(const std::vector<std::string>& words, const char* separator) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : separator) + word;
    return text;
}

}  // namespace

std::string Interval::text() const {
    const bool from = std::isfinite(low), to = std::isfinite(high);
    const std::string a = shortestText(low), b = shortestText(high);
    if (infinite) return (open_low ? "above " : "of at least ") + a + ", or inf";
    if (from && to) return fmt::format("in {}{}, {}{}", open_low ? '(' : '[', a, b, open_high ? ')' : ']');
    if (from) return (open_low ? "above " : "of at least ") + a;
    if (to) return (open_high ? "below " : "of at most ") + b;
    return {};
}

ParameterTable::ParameterTable(std::string section, std::string about)
    : section_(std::move(section)), about_(std::move(about)) {}

ParameterTable& ParameterTable::custom(Parameter parameter) {
    if (find(parameter.key)) throw std::logic_error("parameter " + section_ + "." + parameter.key + " described twice");
    parameters_.push_back(std::move(parameter));
    return *this;
}

const Parameter* ParameterTable::find(const std::string& key) const {
    for (const auto& parameter : parameters_)
        if (parameter.key == key) return &parameter;
    return nullptr;
}

ParameterTable& ParameterTable::real(const std::string& key, double& field, const std::string& unit,
                                     Interval interval, const std::string& help) {
    const bool deg = isDegrees(key);
    const std::string expected = expectedNumber(interval, unit);
    return custom({key, unit, expected, help,
                   [&field, interval, deg, expected](const std::string& text) -> std::optional<std::string> {
                       const auto value = readNumber(text, interval, deg);
                       if (!value) return expected;
                       field = *value;
                       return std::nullopt;
                   },
                   [&field, deg] { return writeNumber(field, deg); }});
}

ParameterTable& ParameterTable::optionalReal(const std::string& key, std::optional<double>& field,
                                             const std::string& unit, Interval interval, const std::string& help) {
    const bool deg = isDegrees(key);
    const std::string expected = expectedNumber(interval, unit) + " or 'auto'";
    return custom({key, unit, expected, help,
                   [&field, interval, deg, expected](const std::string& text) -> std::optional<std::string> {
                       if (trimmed(text) == "auto") {
                           field.reset();
                           return std::nullopt;
                       }
                       const auto value = readNumber(text, interval, deg);
                       if (!value) return expected;
                       field = *value;
                       return std::nullopt;
                   },
                   [&field, deg] { return field ? writeNumber(*field, deg) : std::string("auto"); }});
}

ParameterTable& ParameterTable::reals(const std::string& key, std::vector<double>& field, const std::string& unit,
                                      Interval interval, const std::string& help) {
    const bool deg = isDegrees(key);
    const std::string expected = expectedNumber(interval, unit, "numbers separated by commas, each");
    return custom({key, unit, expected, help,
                   [&field, interval, deg, expected](const std::string& text) -> std::optional<std::string> {
                       std::vector<double> values;
                       // A last comma would announce a number that is not there.
                       if (const std::string word = trimmed(text); !word.empty() && word.back() == ',')
                           return expected;
                       std::stringstream parts(text);
                       for (std::string part; std::getline(parts, part, ',');) {
                           const auto value = readNumber(part, interval, deg);
                           if (!value) return expected;
                           values.push_back(*value);
                       }
                       field = std::move(values);
                       return std::nullopt;
                   },
                   [&field, deg] {
                       std::vector<std::string> words;
                       for (const double value : field) words.push_back(writeNumber(value, deg));
                       return joined(words, ", ");
                   }});
}

ParameterTable& ParameterTable::integer(const std::string& key, int& field, Interval interval,
                                        const std::string& help) {
    const std::string expected = expectedNumber(interval, "", "a whole number");
    return custom({key, "-", expected, help,
                   [&field, interval, expected](const std::string& text) -> std::optional<std::string> {
                       const std::string word = trimmed(text);
                       int value = 0;
                       const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
                       if (error != std::errc() || end != word.data() + word.size() || !interval.contains(value))
                           return expected;
                       field = value;
                       return std::nullopt;
                   },
                   [&field] { return std::to_string(field); }});
}

ParameterTable& ParameterTable::seed(const std::string& key, std::uint64_t& field, const std::string& help) {
    const std::string expected = "a whole number from 0 to 18446744073709551615";
    return custom({key, "-", expected, help,
                   [&field, expected](const std::string& text) -> std::optional<std::string> {
                       const std::string word = trimmed(text);
                       std::uint64_t value = 0;
                       const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
                       if (error != std::errc() || end != word.data() + word.size()) return expected;
                       field = value;
                       return std::nullopt;
                   },
                   [&field] { return std::to_string(field); }});
}

ParameterTable& ParameterTable::flag(const std::string& key, bool& field, const std::string& help) {
    return choice(key, field, std::vector<std::pair<std::string, bool>>{{"true", true}, {"false", false}}, help);
}

ParameterTable& ParameterTable::text(const std::string& key, std::string& field, const std::string& help) {
    return custom({key, "-", "text", help,
                   [&field](const std::string& text) -> std::optional<std::string> {
                       field = trimmed(text);
                       return std::nullopt;
                   },
                   [&field] { return field; }});
}

ParameterTable& ParameterTable::choiceByIndex(const std::string& key, std::vector<std::string> words,
                                              std::function<void(std::size_t)> set,
                                              std::function<std::size_t()> get, const std::string& help) {
    const std::string expected = "one of " + joined(words, " | ");
    return custom({key, "-", expected, help,
                   [words, set, expected](const std::string& text) -> std::optional<std::string> {
                       const std::string word = trimmed(text);
                       const auto found = std::find(words.begin(), words.end(), word);
                       if (found != words.end()) {
                           set(static_cast<std::size_t>(found - words.begin()));
                           return std::nullopt;
                       }
                       const auto near = nearestWord(word, words);
                       return near ? expected + " (did you mean '" + *near + "'?)" : expected;
                   },
                   [words, get] { return words[get()]; }});
}

std::string shortestText(double value) {
    return fmt::format("{}", value);
}

std::optional<double> numberFromText(const std::string& text) {
    double value = 0;
    const char* begin = text.data();
    const char* const end = begin + text.size();
    if (end - begin > 1 && begin[0] == '+' && begin[1] != '-') ++begin;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (begin == end || error != std::errc() || stop != end || std::isnan(value)) return std::nullopt;
    return value;
}

std::optional<std::string> nearestWord(const std::string& word, const std::vector<std::string>& candidates) {
    const auto distance = [&](const std::string& other) {
        std::vector<std::size_t> row(other.size() + 1);
        for (std::size_t j = 0; j <= other.size(); ++j) row[j] = j;
        for (std::size_t i = 1; i <= word.size(); ++i) {
            std::size_t diagonal = row[0];
            row[0] = i;
            for (std::size_t j = 1; j <= other.size(); ++j) {
                const std::size_t substituted = diagonal + (word[i - 1] == other[j - 1] ? 0 : 1);
                diagonal = row[j];
                row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
            }
        }
        return row.back();
    };
    std::optional<std::string> best;
    std::size_t best_distance = 1 + std::max<std::size_t>(word.size() / 3, 1);
    for (const auto& candidate : candidates)
        if (const std::size_t d = distance(candidate); d < best_distance && d < candidate.size()) {
            best = candidate;
            best_distance = d;
        }
    return best;
}

std::string toIni(const ParameterTable& table) {
    std::string text = "# " + table.about() + "\n[" + table.section() + "]\n";
    for (const auto& parameter : table.parameters())
        text += fmt::format("# {} Expected: {}.\n{} = {}\n", parameter.help, parameter.expected, parameter.key,
                            parameter.print());
    return text;
}

std::string toMarkdown(const ParameterTable& table) {
    std::string text = fmt::format("### `[{}]`\n\n{}\n\n| key | default | unit | expected | meaning |\n|---|---|---|---|---|\n",
                                   table.section(), table.about());
    const auto cell = [](std::string words) {
        for (std::size_t i = 0; (i = words.find('|', i)) != std::string::npos; i += 2) words.insert(i, 1, '\\');
        return words;
    };
    for (const auto& parameter : table.parameters())
        text += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", parameter.key, cell(parameter.print()),
                            parameter.unit, cell(parameter.expected), cell(parameter.help));
    return text;
}

}  // namespace slamot

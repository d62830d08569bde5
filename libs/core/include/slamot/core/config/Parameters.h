#pragma once
// One description of a component's parameters. Everything else (reading a config file, printing a commented one,
// the tables in the docs, validation) is made from it.
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace slamot {

/// The values a number may take. Endpoints belong to it unless marked open.
struct Interval {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool open_low = false, open_high = false;
    /// Whether "inf" may be given: only where 'no limit' means something.
    bool infinite = false;

    bool contains(double v) const {
        return (open_low ? v > low : v >= low) && (open_high ? v < high : v <= high);
    }
    std::string text() const;

    static Interval any() { return {}; }
    static Interval positive() { return {0, std::numeric_limits<double>::infinity(), true, false}; }
    static Interval positiveOrInfinite() { return {0, std::numeric_limits<double>::infinity(), true, false, true}; }
    static Interval nonNegative() { return {0, std::numeric_limits<double>::infinity(), false, false}; }
    static Interval probability() { return {0, 1, false, false}; }
    static Interval openProbability() { return {0, 1, true, true}; }
    static Interval atLeast(double low) { return {low, std::numeric_limits<double>::infinity(), false, false}; }
    static Interval between(double low, double high) { return {low, high, false, false}; }
};

/// One key of a config section, tied to the field that holds it.
struct Parameter {
    std::string key, unit, expected, help;
    /// Takes text into the field; returns what is wrong with it, or nothing.
    std::function<std::optional<std::string>(const std::string& text)> parse;
    /// The field as text that `parse` takes back unchanged.
    std::function<std::string()> print;
};

/// The parameters of one section. Holds references to the fields: it must not outlive the struct it describes.
/// Angles are radians inside; a key that ends in `_deg` is read and printed in degrees. "inf" is legal
/// only where the interval says so.
class ParameterTable {
   public:
    ParameterTable(std::string section, std::string about);

    ParameterTable& real(const std::string& key, double& field, const std::string& unit, Interval interval,
                         const std::string& help);
    /// Like `real`, with the word `auto` for 'not given'.
    ParameterTable& optionalReal(const std::string& key, std::optional<double>& field, const std::string& unit,
                                 Interval interval, const std::string& help);
    /// Comma-separated numbers.
    ParameterTable& reals(const std::string& key, std::vector<double>& field, const std::string& unit,
                          Interval interval, const std::string& help);
    ParameterTable& integer(const std::string& key, int& field, Interval interval, const std::string& help);
    /// A 64-bit seed.
    ParameterTable& seed(const std::string& key, std::uint64_t& field, const std::string& help);
    ParameterTable& flag(const std::string& key, bool& field, const std::string& help);
    ParameterTable& text(const std::string& key, std::string& field, const std::string& help);

    template <class Enum>
    ParameterTable& choice(const std::string& key, Enum& field, std::vector<std::pair<std::string, Enum>> names,
                           const std::string& help) {
        std::vector<std::string> words;
        for (const auto& [word, value] : names) words.push_back(word);
        auto set = [&field, names](std::size_t i) { field = names[i].second; };
        auto get = [&field, names] {
            std::size_t i = 0;
            while (names[i].second != field) ++i;
            return i;
        };
        return choiceByIndex(key, std::move(words), set, get, help);
    }

    /// For a field of its own form: `parse` and `print` as in Parameter.
    ParameterTable& custom(Parameter parameter);

    const std::string& section() const { return section_; }
    const std::string& about() const { return about_; }
    const std::vector<Parameter>& parameters() const { return parameters_; }
    const Parameter* find(const std::string& key) const;

   private:
    ParameterTable& choiceByIndex(const std::string& key, std::vector<std::string> words,
                                  std::function<void(std::size_t)> set, std::function<std::size_t()> get,
                                  const std::string& help);

    std::string section_, about_;
    std::vector<Parameter> parameters_;
};

/// The shortest decimal text that reads back as the same double.
std::string shortestText(double value);
/// The whole of `text` as a finite or infinite number; nothing for anything else (also for NaN).
std::optional<double> numberFromText(const std::string& text);
/// The word of `candidates` nearest to `word` by edit distance, if any is near enough to be a likely slip.
std::optional<std::string> nearestWord(const std::string& word, const std::vector<std::string>& candidates);

/// A commented INI block: what `slamot config` prints.
std::string toIni(const ParameterTable& table);
/// A Markdown table for the docs, from the present values.
std::string toMarkdown(const ParameterTable& table);

}  // namespace slamot

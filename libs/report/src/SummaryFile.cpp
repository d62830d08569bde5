#include "SummaryFile.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "slamot/core/config/Config.h"
#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::report {
namespace {

using nlohmann::json;

constexpr const char* summary_name = "/summary.json";

/// A member of an object; null where it is absent.
const json& member(const json& object, const char* name) {
    static const json none;
    const auto found = object.find(name);
    return found == object.end() ? none : *found;
}

class ShapeCheck {
  public:
    explicit ShapeCheck(std::string file) : file_(std::move(file)) {}

    void whole(const json& summary) const {
        if (!summary.is_object() || member(summary, "program") != "slamot") {
            throw LogError(
                fmt::format("{}: is not what slamot writes, expected the summary of a run", file_));
        }
        for (const char* name : {"status", "directory", "log", "truth", "estimator", "detector", "version", "config",
                                 "estimate_sha256", "end_message"}) {
            text(summary, name, name);
        }
        require(member(summary, "warnings"), "warnings", "a list", &json::is_array);
        for (const json& drop : list(summary, "drops")) {
            text(drop, "sensor", "drops");
            text(drop, "reason", "drops");
            require(member(drop, "count"), "drops", "a whole count each", &json::is_number_integer);
        }
        for (const json& sensor : list(summary, "sensors")) {
            for (const char* name : {"x", "y", "theta", "max_range", "field_of_view"}) {
                require(member(sensor, name), "sensors", "numbers, or null where one is infinite",
                        &json::is_number);
            }
        }
    }

  private:
    using Kind = bool (json::*)() const noexcept;

    /// What is absent or null is what a run may leave out.
    void require(const json& value, const std::string& name, const char* expected, Kind kind) const {
        if (!value.is_null() && !(value.*kind)()) {
            throw LogError(fmt::format("{}: '{}' is of another kind, expected {}", file_, name, expected));
        }
    }
    void text(const json& object, const char* name, const std::string& place) const {
        require(member(object, name), place, "text", &json::is_string);
    }
    const json& list(const json& summary, const char* name) const {
        static const json none = json::array();
        const json& all = member(summary, name);
        require(all, name, "a list of objects", &json::is_array);
        for (const json& one : all) {
            require(one, name, "a list of objects", &json::is_object);
        }
        return all.is_null() ? none : all;
    }

    std::string file_;
};

}  // namespace

json readSummary(const std::string& folder) {
    const std::string file = folder + summary_name;
    if (!std::filesystem::exists(file)) {
        const bool begun = std::filesystem::exists(folder + "/trajectory.csv");
        throw LogError(begun ? fmt::format("{}: has no summary.json: the run in it is still going on or was "
                                           "killed, expected one that came to an end; run it again",
                                           folder)
                             : fmt::format("{}: has no summary.json, expected the output folder of a run",
                                           folder));
    }
    std::ifstream in(file, std::ios::binary);
    const json summary = json::parse(in, nullptr, false);
    ShapeCheck(file).whole(summary);
    return summary;
}

eval::EvaluationOptions evaluationOf(const json& summary, const std::string& folder) {
    const std::string file = folder + summary_name;
    const json::json_pointer options_place("/metrics/options");
    Config config;
    try {
        if (summary.contains(options_place) && summary.at(options_place).is_object()) {
            // eval prints its options as text, as config files have them.
            for (const auto& [key, value] : summary.at(options_place).items()) {
                config.set("eval", key, value.is_string() ? value.get<std::string>() : value.dump(), file);
            }
        } else if (const json& text = member(summary, "config"); text.is_string()) {
            const Config settings = Config::fromText(text.get<std::string>(), file);
            for (const auto& [key, entry] : settings.section("eval")) {
                config.set("eval", key, entry.value, file);
            }
        }
        eval::EvaluationOptions options;
        load(eval::describe(options), config);
        return options;
    } catch (const ConfigError& error) {
        const std::string what = error.what();
        throw LogError(what.rfind(file, 0) == 0 ? what : file + ": " + what);
    }
}

}  // namespace slamot::report

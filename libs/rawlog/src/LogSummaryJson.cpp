#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "slamot/rawlog/LogCheck.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {

using nlohmann::json;

NLOHMANN_JSON_SERIALIZE_ENUM(LogFormat,
                             {{LogFormat::observations, "observations"}, {LogFormat::action_frames, "action-frames"}})
NLOHMANN_JSON_SERIALIZE_ENUM(LogEnd, {{LogEnd::not_yet, "not yet"},
                                      {LogEnd::clean, "clean"},
                                      {LogEnd::truncated, "truncated"},
                                      {LogEnd::corrupt, "corrupt"}})

static void to_json(json& j, const SensorSummary& s) {
    j = {{"class", s.class_name},
         {"label", s.label},
         {"count", s.count},
         {"first_ticks", s.first.ticks},
         {"last_ticks", s.last.ticks},
         {"detections", s.detections},
         {"identified", s.identified},
         {"has_velocities", s.has_velocities},
         {"has_noise", s.has_noise}};
}

static void from_json(const json& j, SensorSummary& s) {
    j.at("class").get_to(s.class_name);
    j.at("label").get_to(s.label);
    j.at("count").get_to(s.count);
    j.at("first_ticks").get_to(s.first.ticks);
    j.at("last_ticks").get_to(s.last.ticks);
    j.at("detections").get_to(s.detections);
    j.at("identified").get_to(s.identified);
    j.at("has_velocities").get_to(s.has_velocities);
    j.at("has_noise").get_to(s.has_noise);
}

std::string toJson(const LogSummary& summary) {
    json drops = json::array();
    for (const auto& [row, count] : summary.drops.rows())
        drops.push_back({{"sensor", row.first}, {"reason", row.second}, {"count", count}});
    const json j = {{"format", summary.format},   {"timed_by_step", summary.timed_by_step},
                    {"end", summary.end},         {"end_message", summary.end_message},
                    {"objects", summary.objects}, {"sensors", summary.sensors},
                    {"drops", drops}};
    // Labels of a broken log may be no UTF-8 at all.
    return j.dump(-1, ' ', false, json::error_handler_t::replace);
}

LogSummary logSummaryFromJson(const std::string& text) {
    try {
        const json j = json::parse(text);
        LogSummary summary;
        j.at("format").get_to(summary.format);
        j.at("timed_by_step").get_to(summary.timed_by_step);
        j.at("end").get_to(summary.end);
        j.at("end_message").get_to(summary.end_message);
        j.at("objects").get_to(summary.objects);
        j.at("sensors").get_to(summary.sensors);
        for (const auto& drop : j.at("drops"))
            summary.drops.add(drop.at("sensor"), drop.at("reason"), drop.at("count").get<std::int64_t>());
        return summary;
    } catch (const json::exception& error) {
        throw LogError(fmt::format("the summary of a log cannot be understood ({})", error.what()));
    }
}

}  // namespace slamot

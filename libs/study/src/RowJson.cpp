#include "RowJson.h"

#include <cmath>

#include "CostFields.h"

namespace slamot::study {
namespace {

using Json = nlohmann::json;

Json number(double value) {
    if (std::isfinite(value)) return value;
    if (std::isnan(value)) return nullptr;
    return value > 0 ? "inf" : "-inf";
}

double numberFrom(const Json& json) {
    if (json.is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (json.is_string())
        return json == "inf" ? std::numeric_limits<double>::infinity()
                             : -std::numeric_limits<double>::infinity();
    return json.get<double>();
}

Json numbers(const std::vector<double>& values) {
    Json list = Json::array();
    for (const double value : values) list.push_back(number(value));
    return list;
}

std::vector<double> numbersFrom(const Json& json) {
    std::vector<double> values;
    values.reserve(json.size());
    for (const Json& value : json) values.push_back(numberFrom(value));
    return values;
}

}  // namespace

Json pointJson(const GridPoint& point) {
    Json list = Json::array();
    for (const auto& [key, value] : point) list.push_back({key, value});
    return list;
}

GridPoint pointFrom(const Json& json) {
    GridPoint point;
    for (const Json& pair : json) point.emplace_back(pair.at(0), pair.at(1));
    return point;
}

Json metricsJson(const std::map<std::string, double>& metrics) {
    Json object = Json::object();
    for (const auto& [name, value] : metrics) object[name] = number(value);
    return object;
}

std::map<std::string, double> metricsFrom(const Json& json) {
    std::map<std::string, double> metrics;
    for (const auto& [name, value] : json.items()) metrics[name] = numberFrom(value);
    return metrics;
}

Json seriesJson(const std::map<std::string, Series>& series) {
    Json object = Json::object();
    for (const auto& [name, one] : series) {
        object[name] = {{"seconds", numbers(one.seconds)}, {"value", numbers(one.value)}};
        if (!one.dimension.empty()) object[name]["dimension"] = numbers(one.dimension);
    }
    return object;
}

std::map<std::string, Series> seriesFrom(const Json& json) {
    std::map<std::string, Series> series;
    for (const auto& [name, one] : json.items())
        series[name] = {numbersFrom(one.at("seconds")), numbersFrom(one.at("value")),
                        one.contains("dimension") ? numbersFrom(one.at("dimension")) : std::vector<double>()};
    return series;
}

Json costJson(const Cost& cost) {
    Json object = {{"host", cost.host}};
    for (const auto& [name, field] : cost_fields) object[name] = number(cost.*field);
    return object;
}

Cost costFrom(const Json& json) {
    Cost cost;
    cost.host = json.at("host");
    for (const auto& [name, field] : cost_fields)
        if (json.contains(name)) cost.*field = numberFrom(json.at(name));
    return cost;
}

std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace slamot::study

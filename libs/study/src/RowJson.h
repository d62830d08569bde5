#pragma once
// Rows and their parts as JSON. Every number comes back bit for bit; JSON has no word for those that are not
// finite, so NaN is null and infinities are texts.
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "slamot/study/Row.h"

namespace slamot::study {

nlohmann::json pointJson(const GridPoint& point);
GridPoint pointFrom(const nlohmann::json& json);
nlohmann::json metricsJson(const std::map<std::string, double>& metrics);
std::map<std::string, double> metricsFrom(const nlohmann::json& json);
nlohmann::json seriesJson(const std::map<std::string, Series>& series);
std::map<std::string, Series> seriesFrom(const nlohmann::json& json);
nlohmann::json costJson(const Cost& cost);
Cost costFrom(const nlohmann::json& json);

/// As text; labels of logs in a reason may be no UTF-8.
std::string dumped(const nlohmann::json& json);

}  // namespace slamot::study

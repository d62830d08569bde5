#pragma once
// The scenario values that are more than one number, as text: points `x,y`, boxes `x_min,x_max,y_min,y_max`,
// paths, speed levels, schedules.
#include <optional>
#include <string>
#include <vector>

#include "slamot/sim/Scenario.h"

namespace slamot::sim {

void addPoint(ParameterTable& table, const std::string& key, Vector2& field, const std::string& unit,
              const std::string& help);
/// With the word `auto` for 'not given'.
void addPoint(ParameterTable& table, const std::string& key, std::optional<Vector2>& field,
              const std::string& unit, const std::string& help);
void addBox(ParameterTable& table, const std::string& key, Box& field, const std::string& help);
/// With the word `none` for 'not given'.
void addBox(ParameterTable& table, const std::string& key, std::optional<Box>& field,
            const std::string& help);
void addPath(ParameterTable& table, const std::string& key, std::vector<Vector2>& field,
             const std::string& help);
void addLevels(ParameterTable& table, const std::string& key, std::vector<SpeedLevel>& field,
               const std::string& help);
void addSchedule(ParameterTable& table, const std::string& key, std::vector<ScheduleEntry>& field,
                 const std::string& help);
void addId(ParameterTable& table, const std::string& key, SourceId& field, const std::string& help);
/// Whole numbers from 0 separated by commas, or the word `all` for an empty list.
void addNumbers(ParameterTable& table, const std::string& key, std::vector<int>& field,
                const std::string& help);

/// The whole of `text` as a whole number from 0 to 999999.
std::optional<int> smallNumberFromText(const std::string& text);

}  // namespace slamot::sim

#pragma once
#include <array>

#include "slamot/study/Analysis.h"

namespace slamot::study {

struct StatisticField {
    const char* name;
    double Statistic::*field;
    bool in_tables;  ///< in the CSV of a table, beside the count; exports have all
};

/// The numbers of Statistic by name.
inline constexpr std::array<StatisticField, 8> statistic_fields = {{
    {"mean", &Statistic::mean, true},
    {"half_width", &Statistic::half_width, true},
    {"deviation", &Statistic::deviation, false},
    {"median", &Statistic::median, true},
    {"median_low", &Statistic::median_low, true},
    {"median_high", &Statistic::median_high, true},
    {"minimum", &Statistic::minimum, false},
    {"maximum", &Statistic::maximum, false},
}};

}  // namespace slamot::study

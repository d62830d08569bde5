#pragma once
// What a check may judge: one line of the table in CheckStatistic.cpp each.
#include <string>
#include <variant>
#include <vector>

#include "slamot/study/Analysis.h"

namespace slamot::study {

using OfFigure = double (*)(const Statistic&);
using OfPairs = double (*)(const Paired&);
using OfSeries = double (*)(const eval::ConsistencyOverRuns&);
using OfDivergence = double (*)(const Divergence&);

struct CheckStatistic {
    std::string name;   ///< in the study file
    std::string words;  ///< {} stands for the figure or series
    bool in_unit;       ///< the value has the figure's unit
    /// NaN where there is no value. Which of these it is decides what keys the check has: `figure`, `figure`
    /// and `against`, `series`, or none.
    std::variant<OfFigure, OfPairs, OfSeries, OfDivergence> value;

    bool ofPairs() const { return std::holds_alternative<OfPairs>(value); }
    bool ofSeries() const { return std::holds_alternative<OfSeries>(value); }
    bool ofFigure() const { return ofPairs() || std::holds_alternative<OfFigure>(value); }
};

const std::vector<CheckStatistic>& checkStatistics();

}  // namespace slamot::study

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
/// Of what each run's series has in a window of time on the average.
struct OfWindow {
    double (*of)(const Statistic&);
};

struct CheckStatistic {
    std::string name;   ///< in the study file
    std::string words;  ///< {} stands for the figure or series, of a window with its ends
    bool in_unit;       ///< the value has the figure's unit
    /// NaN where there is no value. Which of these it is decides what keys the check has: `figure`, `figure`
    /// and `against`, `series`, `series` and `window`, or none.
    std::variant<OfFigure, OfPairs, OfSeries, OfWindow, OfDivergence> value;

    bool ofPairs() const { return std::holds_alternative<OfPairs>(value); }
    bool ofNees() const { return std::holds_alternative<OfSeries>(value); }
    bool ofWindow() const { return std::holds_alternative<OfWindow>(value); }
    bool ofSeries() const { return ofNees() || ofWindow(); }
    bool ofFigure() const { return ofPairs() || std::holds_alternative<OfFigure>(value); }
};

const std::vector<CheckStatistic>& checkStatistics();

/// For each run that has the series there, its mean over the window [s], ends included.
std::vector<double> windowMeans(const Cell& cell, const std::string& series, const eval::Band& window);

}  // namespace slamot::study

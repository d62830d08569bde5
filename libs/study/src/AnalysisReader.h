#pragma once
// One section each of a study file's analysis. All throw ConfigError.
#include "SectionReader.h"
#include "slamot/study/AnalysisFile.h"

namespace slamot::study {

TableSpec readTable(const StudyFile& study, const std::string& section);
PlotSpec readPlot(const StudyFile& study, const std::string& section);
CheckSpec readCheck(const StudyFile& study, const std::string& section);

/// The figure must be one a row can have, the series one the study keeps, the others of the study. An empty
/// selection becomes all.
void requireFigures(const StudyFile& study, const std::string& section, const std::string& key,
                    const std::vector<std::string>& figures);
void requireSeries(const StudyFile& study, const std::string& section, const std::string& key,
                   const std::vector<std::string>& series);
/// As requireSeries, and of NEES.
void requireNees(const StudyFile& study, const std::string& section, const std::string& key,
                 const std::vector<std::string>& series);
void requireSource(const StudyFile& study, const Config::Entry& entry, const std::string& section,
                   const std::string& source);
void requireConfig(const StudyFile& study, const Config::Entry& entry, const std::string& section,
                   const std::string& config);
void completeSelection(const StudyFile& study, const std::string& section, Selection& selection);

}  // namespace slamot::study

#pragma once
// Tables of a study as values, and as Markdown and CSV.
#include <string>
#include <vector>

#include "slamot/study/Analysis.h"
#include "slamot/study/AnalysisFile.h"
#include "slamot/study/Row.h"

namespace slamot::study {

class OneRuns;

/// Rows with the study they belong to and what it wants made of them.
struct Findings {
    const StudyFile& study;
    const Analysis& analysis;
    const std::vector<Row>& rows;
    const Plan* plan = nullptr;  ///< what there should be; null where that is not known
    /// Of that plan: makes what figures of one run show; without it they have no such run.
    OneRuns* one_runs = nullptr;
};

struct Column {
    std::string heading;
    /// What the CSV has in its place: one column or several, such as a figure's mean and half width.
    std::vector<std::string> csv;
    bool numeric = false;  ///< aligned to the right
};

/// One place of a table: rounded for people, and for programs as text that reads back unchanged, one for each
/// of Column::csv.
struct Field {
    std::string shown;
    std::vector<std::string> csv;
};

struct TableLine {
    std::vector<Field> fields;
    bool summary = false;  ///< stands out in Markdown and is no part of the CSV
};

struct Table {
    std::string caption;
    std::vector<Column> columns;
    std::vector<TableLine> lines;
};

Table makeTable(const TableSpec& spec, const Findings& findings);

/// GitHub's Markdown, padded so that it reads as plain text too; ends with a newline.
std::string toMarkdown(const Table& table);
/// A header, and fields as csvField has them.
std::string toCsv(const Table& table);

}  // namespace slamot::study

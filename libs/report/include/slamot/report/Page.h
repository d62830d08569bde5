#pragma once
// A self-contained HTML page: text, tables, interactive figures. One shell for runs, comparisons and studies;
// it needs no network and no other file.
#include <string>
#include <variant>
#include <vector>

#include "slamot/report/Figure.h"

namespace slamot::report {

struct Paragraph {
    std::string text;
};

/// Text as it is: a configuration, a command. With a `summary` it is folded away under it.
struct Verbatim {
    std::string text, summary;
    bool can_be_copied = false;
};

struct TableCell {
    std::string text;
    bool best = false;  ///< marked as the best of its row
};

struct TableRow {
    std::vector<TableCell> cells;
    bool group = false;   ///< a heading within the table: its first cell alone
    bool strong = false;  ///< stands out: a sum, a ranking's result
};

struct TableColumn {
    std::string heading;
    bool numeric = true;  ///< aligned to the right
};

/// The first column names the rows.
struct PageTable {
    std::string caption;
    std::vector<TableColumn> columns;
    std::vector<TableRow> rows;
};

/// `alt` says what is seen, for who does not see it; `name` is the picture's file name.
struct PageFigure {
    std::string name, alt;
    Figure figure;
    std::string caption;
};

/// A box beside the replay.
struct ReplayChoice {
    std::string id, label;
    bool on = true;
};

/// What one of the things in the replay looks like, for the list below it.
struct ReplayKey {
    enum class Symbol { arrow, square, cross, wide_line, line, disc, frame, dots };
    Symbol symbol;
    std::string words;
    std::string colour;  ///< of the light theme
};

/// The replay of a run (assets/replay.js), its data as JSON.
struct ReplayView {
    std::string alt, data;
    std::string note;  ///< stands below
    std::vector<ReplayChoice> choices;
    std::vector<ReplayKey> keys;
};

using Block = std::variant<Paragraph, Verbatim, PageTable, PageFigure, ReplayView>;

struct PageSection {
    std::string id, title;
    std::string about;  ///< how to read what follows
    std::vector<Block> blocks;
};

struct Page {
    std::string title, subtitle;
    std::vector<PageSection> sections;
    std::string footer;
};

/// The whole page. Everything in `page` is text, never markup.
std::string toHtml(const Page& page);

/// Writes toHtml(page). Throws ReportError (FigureWriter.h) where the file cannot be written.
void writePage(const Page& page, const std::string& file);

/// The page's figures as FOLDER/NAME.svg and .png. Throws ReportError.
void writePictures(const Page& page, const std::string& folder);

}  // namespace slamot::report

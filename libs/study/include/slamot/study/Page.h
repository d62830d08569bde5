#pragma once
// Tables and figures of a study in a page of the docs, between marks in comments.
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "slamot/study/Checks.h"
#include "slamot/study/Tables.h"

namespace slamot::study {

/// Where and when a page is filled.
struct Provenance {
    std::string date;       ///< of today, 2026-01-31
    std::string processor;  ///< of this machine
    unsigned cores = 0;
    std::string command;  ///< makes the page again
};
Provenance provenanceHere(const std::string& command);

/// "2026-01-31, AMD EPYC, 2 cores, slamot 0.1.0, from 1190 of 1200 runs (3 failed, 1 truncated; no runs of:
/// mrclam_6)". Rows do not say when and on which processor they were measured. Without Findings::plan neither
/// the number of planned runs nor the skipped sources are known.
std::string originText(const Provenance& provenance, const Findings& findings);

/// "Filled on " originText ": `slamot study ...`".
std::string stampLine(const Provenance& provenance, const Findings& findings);

/// Replaces what stands between a mark of this study and the next `<!-- end -->`:
///
///     <!-- study NAME table TABLE -->    the Markdown table
///     <!-- study NAME figure FIGURE -->  an image, drawn to PAGE_FIGURE.svg beside the page
///     <!-- study NAME checks -->         the table of checks
///     <!-- study NAME stamp -->          stampLine
///
/// Marks of other studies stay as they are. Throws ConfigError, with file and line, for a mark that names
/// nothing of the study, has no end, or wants checks where `checks` is null, and for a page without a mark of
/// this study; the page is then as it was. Throws report::ReportError where a figure cannot be drawn.
void fillPage(const std::string& page, const Findings& findings, const Provenance& provenance,
              const CheckReport* checks);

/// What belongs to a mark, ending with a newline; `words` follow the name. Throws ConfigError for words that
/// name nothing.
using MarkContent = std::function<std::string(const std::vector<std::string>& words)>;

/// A page's text with what stands between each `<!-- KEYWORD NAME words... -->` and the next `<!-- end -->`
/// replaced. Throws ConfigError as fillPage does.
std::string filledText(const std::string& page, const std::string& keyword, const std::string& name,
                       const MarkContent& content);
/// Replaces a page once all of it is written; of a link, the page it leads to. It keeps its permissions.
void writePage(const std::string& page, const std::string& text);

}  // namespace slamot::study

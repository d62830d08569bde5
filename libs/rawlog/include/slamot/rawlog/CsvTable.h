#pragma once
// Comma-separated tables with a header row: every CSV this project writes or imports. Texts are quoted as in
// RFC 4180 where they need it; a row is one line.
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "slamot/core/data/Stamp.h"

namespace slamot {

/// What a last line without a newline and with too few fields means. `may_be_cut`: a crashed writer left it,
/// and it ends the table. `whole`: it is an error like any other short row, so that no import loses a row
/// uncounted.
enum class LastLine { whole, may_be_cut };

/// Reads row by row; columns are found by name. Errors name file, line and column.
class CsvReader {
  public:
    /// Throws LogError when the file cannot be opened or has no header.
    explicit CsvReader(const std::string& file, LastLine last_line = LastLine::whole);

    bool has(const std::string& column) const;
    /// Index for the accessors below; throws LogError when absent.
    int column(const std::string& name) const;
    const std::vector<std::string>& header() const { return header_; }

    /// Goes to the next row; false at the end. A row with another number of fields than the header is an
    /// error that names file and line, but see LastLine.
    bool next();

    bool empty(int column) const;
    std::string text(int column) const;
    /// NaN for an empty field; "nan", "inf" and "-inf" are numbers.
    double number(int column) const;
    double finite(int column) const;
    std::int64_t integer(int column) const;
    /// Decimal seconds, exact to a tick.
    Stamp stamp(int column) const;
    /// Later than that of the last of `samples`.
    template <class Sample>
    Stamp risingStamp(int column, const std::vector<Sample>& samples) const {
        const Stamp now = stamp(column);
        if (!samples.empty() && now <= samples.back().stamp) failNotRising(column, samples.back().stamp);
        return now;
    }
    [[noreturn]] void fail(int column, const std::string& expected) const;

  private:
    [[noreturn]] void failNotRising(int column, Stamp before) const;

    std::string file_;
    LastLine last_line_;
    std::ifstream in_;
    std::vector<std::string> header_, fields_;
    std::int64_t line_ = 0;
};

/// A text as a field: quoted where it holds a comma, a quote or blanks at an end; its line ends become
/// blanks.
std::string csvField(std::string_view text);

/// The shortest text that reads back as the same number, appended to `line` after a comma (none at the start
/// of a line).
void appendField(std::string& line, double value);
void appendField(std::string& line, std::int64_t value);
void appendField(std::string& line, std::string_view text);
void appendField(std::string& line, Stamp stamp);

}  // namespace slamot

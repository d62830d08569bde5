#include "slamot/rawlog/CsvTable.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {
namespace {

bool isBlank(char c) {
    return c == ' ' || c == '\t';
}

std::string trimmed(std::string field) {
    field.erase(field.begin(), std::find_if_not(field.begin(), field.end(), isBlank));
    field.erase(std::find_if_not(field.rbegin(), field.rend(), isBlank).base(), field.end());
    return field;
}

struct Fields {
    std::vector<std::string> texts;
    std::string problem;  ///< with what was expected; empty where the line is well formed
};

/// What stands between quotes keeps its commas and blanks; a doubled quote is one.
Fields fieldsOf(const std::string& line) {
    Fields fields;
    std::size_t at = 0;
    for (;;) {
        std::string field;
        const std::size_t begin = std::min(line.find_first_not_of(" \t", at), line.size());
        const bool quoted = begin < line.size() && line[begin] == '"';
        if (quoted) {
            for (at = begin + 1; at < line.size(); ++at) {
                if (line[at] == '"' && (at + 1 == line.size() || line[at + 1] != '"')) break;
                if (line[at] == '"') ++at;
                field += line[at];
            }
            if (at >= line.size())
                return {{},
                        fmt::format("field {} has no closing quote, expected one", fields.texts.size() + 1)};
            at = line.find_first_not_of(" \t", at + 1);
            if (at != std::string::npos && line[at] != ',')
                return {{},
                        fmt::format("field {} goes on behind its closing quote, expected a comma",
                                    fields.texts.size() + 1)};
        } else {
            const std::size_t comma = line.find(',', at);
            field = trimmed(line.substr(at, comma - at));
            at = comma;
        }
        fields.texts.push_back(std::move(field));
        if (at == std::string::npos || at >= line.size()) return fields;
        ++at;
    }
}

void removeCarriageReturn(std::string& line) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
}

void appendSeparator(std::string& line) {
    if (!line.empty()) line += ',';
}

}  // namespace

CsvReader::CsvReader(const std::string& file, LastLine last_line)
    : file_(file), last_line_(last_line), in_(file) {
    if (!std::filesystem::is_regular_file(file) || !in_)
        throw LogError(fmt::format("{}: cannot be opened, expected a CSV table", file));
    std::string line;
    if (!std::getline(in_, line) || line.empty() || line == "\r")
        throw LogError(
            fmt::format("{}:1: the header row is missing, expected the names of the columns", file));
    removeCarriageReturn(line);
    Fields header = fieldsOf(line);
    if (!header.problem.empty()) throw LogError(fmt::format("{}:1: {}", file, header.problem));
    header_ = std::move(header.texts);
    line_ = 1;
}

bool CsvReader::has(const std::string& column) const {
    return std::find(header_.begin(), header_.end(), column) != header_.end();
}

int CsvReader::column(const std::string& name) const {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found == header_.end())
        throw LogError(fmt::format("{}:1: column '{}' is missing, the header is '{}'", file_, name,
                                   fmt::join(header_, ",")));
    return static_cast<int>(found - header_.begin());
}

bool CsvReader::next() {
    std::string line;
    do {
        if (!std::getline(in_, line)) return false;
        ++line_;
        removeCarriageReturn(line);
    } while (line.empty());
    const bool unfinished = in_.eof();
    Fields fields = fieldsOf(line);
    fields_ = std::move(fields.texts);
    if (fields.problem.empty() && fields_.size() == header_.size()) return true;
    if (unfinished && last_line_ == LastLine::may_be_cut) return false;
    if (!fields.problem.empty()) throw LogError(fmt::format("{}:{}: {}", file_, line_, fields.problem));
    throw LogError(fmt::format("{}:{}: has {} fields, expected {} as in the header", file_, line_,
                               fields_.size(), header_.size()));
}

bool CsvReader::empty(int column) const {
    return fields_[column].empty();
}

std::string CsvReader::text(int column) const {
    return fields_[column];
}

double CsvReader::number(int column) const {
    if (empty(column) || fields_[column] == "nan") return std::numeric_limits<double>::quiet_NaN();
    const auto value = numberFromText(fields_[column]);
    if (!value) fail(column, "a number");
    return *value;
}

double CsvReader::finite(int column) const {
    const double value = number(column);
    if (!std::isfinite(value)) fail(column, "a finite number");
    return value;
}

std::int64_t CsvReader::integer(int column) const {
    const std::string& field = fields_[column];
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size()) fail(column, "an integer");
    return value;
}

Stamp CsvReader::stamp(int column) const {
    try {
        return stampFromText(fields_[column]);
    } catch (const std::invalid_argument&) {
        fail(column, "a time in decimal seconds");
    }
}

void CsvReader::failNotRising(int column, Stamp before) const {
    fail(column, "a time later than the row before, which has " + toText(before));
}

void CsvReader::fail(int column, const std::string& expected) const {
    throw LogError(fmt::format("{}:{}: column '{}' is '{}', expected {}", file_, line_, header_[column],
                               fields_[column], expected));
}

std::string csvField(std::string_view text) {
    // A table's rows are its lines: a line end within a text becomes a blank.
    std::string field;
    for (const char c : text) field += c == '\n' || c == '\r' ? ' ' : c;
    if (field.find_first_of(",\"") == std::string::npos && trimmed(field) == field) return field;
    std::string quoted = "\"";
    for (const char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

void appendField(std::string& line, double value) {
    appendSeparator(line);
    fmt::format_to(std::back_inserter(line), "{}", value);
}

void appendField(std::string& line, std::int64_t value) {
    appendSeparator(line);
    fmt::format_to(std::back_inserter(line), "{}", value);
}

void appendField(std::string& line, std::string_view text) {
    appendSeparator(line);
    line += csvField(text);
}

void appendField(std::string& line, Stamp stamp) {
    appendField(line, std::string_view(toText(stamp)));
}

}  // namespace slamot

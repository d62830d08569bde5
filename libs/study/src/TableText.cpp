#include <algorithm>

#include "CsvLine.h"
#include "MarkdownText.h"
#include "slamot/study/Tables.h"

namespace slamot::study {
namespace {

/// Characters of a UTF-8 text: all bytes but those that continue one.
std::size_t widthOf(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right) {
    const std::string blanks(width - std::min(width, widthOf(text)), ' ');
    return to_the_right ? blanks + text : text + blanks;
}

}  // namespace

std::string toMarkdown(const Table& table) {
    std::vector<std::vector<std::string>> texts(1);
    for (const Column& column : table.columns) texts[0].push_back(markdownText(column.heading));
    for (const TableLine& line : table.lines) {
        std::vector<std::string>& cells = texts.emplace_back();
        for (const Field& field : line.fields) {
            const std::string text = markdownText(field.shown);
            cells.push_back(line.summary && !text.empty() ? "**" + text + "**" : text);
        }
    }

    std::vector<std::size_t> widths(table.columns.size(), 3);
    for (const auto& cells : texts)
        for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], widthOf(cells[i]));

    std::string markdown;
    if (!table.caption.empty()) markdown += table.caption + "\n\n";
    for (std::size_t row = 0; row < texts.size(); ++row) {
        for (std::size_t i = 0; i < texts[row].size(); ++i)
            markdown += "| " + padded(texts[row][i], widths[i], table.columns[i].numeric) + " ";
        markdown += "|\n";
        if (row > 0) continue;
        for (std::size_t i = 0; i < widths.size(); ++i)
            markdown += "|" + std::string(widths[i] + 1, '-') + (table.columns[i].numeric ? ":" : "-");
        markdown += "|\n";
    }
    return markdown;
}

std::string toCsv(const Table& table) {
    std::vector<std::string> header;
    for (const Column& column : table.columns)
        header.insert(header.end(), column.csv.begin(), column.csv.end());
    std::string csv = csvLine(header);
    for (const TableLine& line : table.lines) {
        if (line.summary) continue;
        std::vector<std::string> fields;
        for (const Field& field : line.fields)
            fields.insert(fields.end(), field.csv.begin(), field.csv.end());
        csv += csvLine(fields);
    }
    return csv;
}

}  // namespace slamot::study

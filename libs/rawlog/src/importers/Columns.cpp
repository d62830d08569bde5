#include "Columns.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {

Stamp ColumnRow::stamp(std::size_t i) const {
    try {
        return stampFromText(fields_[i]);
    } catch (const std::invalid_argument&) {
        fail(i, "a time in decimal seconds");
    }
}

double ColumnRow::number(std::size_t i) const {
    const auto value = numberFromText(fields_[i]);
    if (!value || !std::isfinite(*value)) fail(i, "a finite number");
    return *value;
}

std::int64_t ColumnRow::integer(std::size_t i) const {
    const double value = number(i);
    if (value != std::floor(value) || std::abs(value) > 1e9) fail(i, "an integer");
    return static_cast<std::int64_t>(value);
}

void ColumnRow::fail(std::size_t i, const std::string& expected) const {
    throw LogError(fmt::format("{}: field {} is '{}', expected {}", place_, i + 1, fields_[i], expected));
}

void forEachRow(const std::filesystem::path& file, std::size_t columns, const std::string& dataset,
                const std::function<void(const ColumnRow&)>& take) {
    std::ifstream in(file);
    if (!in || !std::filesystem::is_regular_file(file))
        throw LogError(fmt::format("{}: cannot be opened, expected a table of {}", file.string(), dataset));
    std::string line;
    for (std::int64_t number = 1; std::getline(in, line); ++number) {
        std::istringstream words(line.substr(0, line.find('#')));
        std::vector<std::string> fields;
        for (std::string word; words >> word;) fields.push_back(word);
        if (fields.empty()) continue;
        const std::string place = fmt::format("{}:{}", file.string(), number);
        if (fields.size() < columns)
            throw LogError(fmt::format("{}: has {} fields, expected {}", place, fields.size(), columns));
        take(ColumnRow(place, std::move(fields)));
    }
}

}  // namespace slamot

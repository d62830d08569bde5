#include "CsvLine.h"

#include <cmath>

#include "slamot/core/config/Parameters.h"

namespace slamot::study {

std::string csvNumber(double value) {
    return std::isnan(value) ? "" : shortestText(value);
}

std::string csvLine(const std::vector<std::string>& fields) {
    std::string line;
    for (const std::string& field : fields) {
        if (&field != &fields.front()) line += ',';
        if (field.find_first_of(",\"\r\n") == std::string::npos) {
            line += field;
            continue;
        }
        line += '"';
        for (const char c : field) line += c == '"' ? std::string("\"\"") : std::string(1, c);
        line += '"';
    }
    return line + '\n';
}

}  // namespace slamot::study

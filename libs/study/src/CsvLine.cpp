#include "CsvLine.h"

#include <cmath>

#include "slamot/core/config/Parameters.h"
#include "slamot/rawlog/CsvTable.h"

namespace slamot::study {

std::string csvNumber(double value) {
    return std::isnan(value) ? "" : shortestText(value);
}

std::string csvLine(const std::vector<std::string>& fields) {
    std::string line;
    for (const std::string& field : fields) {
        if (&field != &fields.front()) line += ',';
        line += csvField(field);
    }
    return line + '\n';
}

}  // namespace slamot::study

#include "slamot/rawlog/LogSource.h"

namespace slamot {

void DropTable::add(const std::string& sensor, const std::string& reason, std::int64_t count) {
    rows_[{sensor, reason}] += count;
}

std::int64_t DropTable::total() const {
    std::int64_t sum = 0;
    for (const auto& [row, count] : rows_) sum += count;
    return sum;
}

}  // namespace slamot

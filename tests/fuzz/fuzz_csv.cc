// Any bytes are a table or a LogError.
#include "memory_file.h"
#include "slamot/rawlog/CsvTable.h"
#include "slamot/rawlog/LogError.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const MemoryFile file(data, size);
    for (int kind = 0; kind < 4; ++kind) try {
            slamot::CsvReader table(file.name());
            const int last = static_cast<int>(table.header().size()) - 1;
            table.has("t");
            while (table.next()) {
                table.empty(last);
                if (kind == 0) table.text(0);
                if (kind == 1) table.number(last);
                if (kind == 2) table.integer(last);
                if (kind == 3) table.stamp(0);
            }
        } catch (const slamot::LogError&) {
        }
    return 0;
}

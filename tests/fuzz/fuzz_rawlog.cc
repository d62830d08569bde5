// Any bytes are a log that ends somehow or a LogError. What crashes inside MRPT's own classes is why slamot
// looks through logs in a child process first; what crashes in slamot's sources is a bug.
#include <sys/resource.h>

#include "memory_file.h"
#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/RawlogReader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const bool limited = [] {
        const rlimit limit{2ull << 30, 2ull << 30};
        return setrlimit(RLIMIT_AS, &limit) == 0;
    }();
    (void)limited;
    const MemoryFile file(data, size);
    try {
        slamot::RawlogReader reader(file.name(), {});
        while (const auto entry = reader.next()) {
            if (!entry->observation) continue;
            if (const auto* o =
                    dynamic_cast<const mrpt::obs::CObservationOdometry*>(entry->observation.get()))
                slamot::fromMrpt(*o);
            if (const auto* o =
                    dynamic_cast<const mrpt::obs::CObservationBearingRange*>(entry->observation.get()))
                slamot::fromMrpt(*o);
        }
        if (reader.end() == slamot::LogEnd::not_yet) __builtin_trap();
    } catch (const slamot::LogError&) {
    }
    return 0;
}

// Text that reads as a stamp is written as one that reads the same.
#include <cstdlib>
#include <stdexcept>

#include "slamot/core/data/Stamp.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    slamot::Stamp stamp;
    try {
        stamp = slamot::stampFromText(text);
    } catch (const std::invalid_argument&) {
        return 0;
    }
    if (slamot::stampFromText(slamot::toText(stamp)) != stamp) std::abort();
    return 0;
}

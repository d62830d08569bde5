#include "Meters.h"

#include <malloc.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <limits>

namespace slamot::study {
namespace {

/// A line of /proc/self/status [MB].
double statusMegabytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind(name + ":", 0) == 0) return std::stod(line.substr(name.size() + 1)) / 1024;
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void MemoryMeter::start() {
    malloc_trim(0);
    // Makes VmHWM, the most so far, start again from what there is now; proc(5).
    std::ofstream clear("/proc/self/clear_refs");
    const bool cleared = static_cast<bool>(clear << '5' << std::flush);
    before_ = cleared ? statusMegabytes("VmRSS") : std::numeric_limits<double>::quiet_NaN();
}

double MemoryMeter::most() const {
    return statusMegabytes("VmHWM") - before_;
}

std::string hostName() {
    std::array<char, 256> name{};
    gethostname(name.data(), name.size() - 1);
    return name.data();
}

}  // namespace slamot::study

#include "Machine.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "StepTimes.h"

namespace slamot::bench {
namespace {

/// The number of `key` in a file of lines "key: number kB", in bytes.
std::size_t bytesOf(const std::string& file, const std::string& key) {
    std::ifstream in(file);
    for (std::string word; in >> word;)
        if (word == key + ":") {
            std::size_t kilobytes = 0;
            in >> kilobytes;
            return 1024 * kilobytes;
        }
    return 0;
}

/// [s] of all cores together, since the machine started.
double busySeconds() {
    std::ifstream in("/proc/stat");
    std::string name;
    double user, nice, system, idle, waiting, interrupts, soft_interrupts, stolen;
    in >> name >> user >> nice >> system >> idle >> waiting >> interrupts >> soft_interrupts >> stolen;
    return (user + nice + system + interrupts + soft_interrupts + stolen) /
           static_cast<double>(sysconf(_SC_CLK_TCK));
}

double ownSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double wallSeconds() {
    return 1e-3 * timeNow().wall;
}

}  // namespace

std::size_t availableMemory() {
    return bytesOf("/proc/meminfo", "MemAvailable");
}

ResidentGrowth::ResidentGrowth() {
    malloc_trim(0);
    std::ofstream clear("/proc/self/clear_refs");
    clear << 5 << std::flush;  // the peak is now
    if (!clear)
        throw std::runtime_error(
            "/proc/self/clear_refs: cannot be written, expected a kernel that counts pages anew there");
    before_ = bytesOf("/proc/self/status", "VmRSS");
}

std::size_t ResidentGrowth::peak() const {
    return std::max(bytesOf("/proc/self/status", "VmHWM"), before_) - before_;
}

OtherLoad::OtherLoad() : busy_(busySeconds()), own_(ownSeconds()), wall_(wallSeconds()) {}

double OtherLoad::part() const {
    const double others = busySeconds() - busy_ - (ownSeconds() - own_);
    return std::max(others, 0.0) / (std::thread::hardware_concurrency() * (wallSeconds() - wall_));
}

}  // namespace slamot::bench

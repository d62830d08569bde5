#include "FileLock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "slamot/rawlog/LogError.h"

namespace slamot::study {
namespace {

int opened(const std::string& path) {
    struct stat status {};
    const bool folder = stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
    return open(path.c_str(), (folder ? O_RDONLY : O_CREAT | O_RDWR) | O_CLOEXEC, 0644);
}

}  // namespace

FileLock::FileLock(const std::string& path) : descriptor_(opened(path)) {
    int result = descriptor_;
    if (descriptor_ >= 0) do
            result = flock(descriptor_, LOCK_EX);
        while (result < 0 && errno == EINTR);
    if (result >= 0) return;
    const int why = errno;
    if (descriptor_ >= 0) close(descriptor_);
    throw LogError(fmt::format("{}: cannot be locked ({})", path, std::strerror(why)));
}

FileLock::~FileLock() {
    close(descriptor_);
}

}  // namespace slamot::study

#include "slamot/run/PartFile.h"

#include <filesystem>

#include "slamot/rawlog/LogError.h"

namespace slamot::run {

PartFile::PartFile(const std::string& file) : file_(file), out_(file + ".part", std::ios::binary) {
    if (!out_) throw LogError(file + ": cannot be written");
}

void PartFile::line(const std::string& text) {
    out_ << text << '\n';
}

void PartFile::close() {
    out_.close();
    if (!out_) throw LogError(file_ + ": cannot be written to its end (is the disk full?)");
    std::filesystem::rename(file_ + ".part", file_);
}

}  // namespace slamot::run

#include "slamot/run/PartFile.h"

#include <filesystem>

#include "slamot/rawlog/LogError.h"

namespace slamot::run {

PartFile::PartFile(const std::string& file) : file_(file), out_(file + ".part", std::ios::binary) {
    if (!out_) throw LogError(file + ": cannot be written");
}

void PartFile::write(std::string_view bytes) {
    if (!out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) failToWrite();
}

void PartFile::close() {
    out_.close();
    if (!out_) failToWrite();
    std::error_code error;
    std::filesystem::rename(file_ + ".part", file_, error);
    if (error) throw LogError(file_ + ": cannot be renamed from .part (" + error.message() + ")");
}

void PartFile::failToWrite() const {
    throw LogError(file_ + ": cannot be written to its end (is the disk full?)");
}

}  // namespace slamot::run

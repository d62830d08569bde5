#include "slamot/rawlog/PartFile.h"

#include <filesystem>

#include "slamot/rawlog/LogError.h"

namespace slamot {

std::string partOf(const std::string& file) {
    return file + ".part";
}

void finishPart(const std::string& file) {
    std::error_code error;
    std::filesystem::rename(partOf(file), file, error);
    if (error) throw LogError(file + ": cannot be renamed from .part (" + error.message() + ")");
}

PartFile::PartFile(const std::string& file) : file_(file) {
    if (std::filesystem::is_directory(file)) throw LogError(file + ": is a folder, expected a file to write");
    out_.open(partOf(file), std::ios::binary);
    if (!out_) throw LogError(file + ": cannot be written");
}

void PartFile::write(std::string_view bytes) {
    if (!out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) failToWrite();
}

void PartFile::close() {
    out_.close();
    if (!out_) failToWrite();
    finishPart(file_);
}

void PartFile::failToWrite() const {
    throw LogError(file_ + ": cannot be written to its end (is the disk full?)");
}

}  // namespace slamot

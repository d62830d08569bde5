#include "slamot/rawlog/GzFile.h"

#include <fmt/format.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>

#include "GzStream.h"
#include "slamot/rawlog/LogError.h"

namespace slamot {

void writeGzFile(const mrpt::serialization::CSerializable& object, const std::string& file) {
    const std::string part = file + ".part";
    GzWriter bytes(part);
    mrpt::serialization::archiveFrom<mrpt::io::CStream>(bytes) << object;
    bytes.close();
    std::error_code error;
    std::filesystem::rename(part, file, error);
    if (error) throw LogError(fmt::format("{}: cannot be renamed from .part ({})", file, error.message()));
}

}  // namespace slamot

#include "GzFile.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/io/zip.h>
#include <mrpt/serialization/CArchive.h>

#include <cstdint>
#include <vector>

#include "slamot/rawlog/LogError.h"
#include "slamot/run/PartFile.h"

namespace slamot::run {

void writeGzFile(const mrpt::serialization::CSerializable& object, const std::string& file) {
    PartFile part(file);
    mrpt::io::CMemoryStream memory;
    mrpt::serialization::archiveFrom(memory) << object;
    const auto* data = static_cast<const std::uint8_t*>(memory.getRawBufferData());
    const std::vector<std::uint8_t> bytes(data, data + memory.getTotalBytesCount());
    std::vector<std::uint8_t> compressed;
    if (!mrpt::io::zip::compress_gz_data_block(bytes, compressed))
        throw LogError(file + ": cannot be compressed");
    part.write({reinterpret_cast<const char*>(compressed.data()), compressed.size()});
    part.close();
}

}  // namespace slamot::run

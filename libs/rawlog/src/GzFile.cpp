#include "slamot/rawlog/GzFile.h"

#include <mrpt/serialization/CArchive.h>

#include "GzStream.h"
#include "slamot/rawlog/PartFile.h"

namespace slamot {

void writeGzFile(const mrpt::serialization::CSerializable& object, const std::string& file) {
    GzWriter bytes(partOf(file));
    mrpt::serialization::archiveFrom<mrpt::io::CStream>(bytes) << object;
    bytes.close();
    finishPart(file);
}

}  // namespace slamot

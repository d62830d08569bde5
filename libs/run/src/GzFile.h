#pragma once
#include <mrpt/serialization/CSerializable.h>

#include <string>

namespace slamot::run {

/// Writes one object the way MRPT's own programs read it, gz-compressed, as a PartFile. MRPT's own gz stream
/// keeps silent about a full disk. Throws LogError.
void writeGzFile(const mrpt::serialization::CSerializable& object, const std::string& file);

}  // namespace slamot::run

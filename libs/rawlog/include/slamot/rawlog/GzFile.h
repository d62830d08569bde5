#pragma once
#include <mrpt/serialization/CSerializable.h>

#include <string>

namespace slamot {

/// Writes one object the way MRPT's own programs read it, gz-compressed: as NAME.part first, renamed when
/// whole. MRPT's own ways do not do: its gz stream keeps silent about a full disk, and its compression of a
/// block goes through a temporary file whose name two programs at once may share. Throws LogError.
void writeGzFile(const mrpt::serialization::CSerializable& object, const std::string& file);

}  // namespace slamot

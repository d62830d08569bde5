#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/rawlog/Sha256.h"

namespace slamot {

std::string sha256OfFile(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!std::filesystem::is_regular_file(file) || !in)
        throw LogError(fmt::format("{}: cannot be opened to compute its checksum", file));
    Sha256 sum;
    std::vector<char> buffer(1 << 16);
    while (in) {
        in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
        sum.add(buffer.data(), static_cast<std::size_t>(in.gcount()));
    }
    if (in.bad()) throw LogError(fmt::format("{}: cannot be read to compute its checksum", file));
    return sum.hex();
}

Checksum checkChecksum(const std::string& file) {
    std::ifstream in(file + ".sha256");
    std::string expected;
    if (!in) return Checksum::none;
    in >> expected;
    return expected == sha256OfFile(file) ? Checksum::matches : Checksum::differs;
}

}  // namespace slamot

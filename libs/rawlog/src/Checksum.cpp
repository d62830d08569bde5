#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/RawlogWriter.h"

namespace slamot {

std::string sha256OfFile(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!std::filesystem::is_regular_file(file) || !in)
        throw LogError(fmt::format("{}: cannot be opened to compute its checksum", file));
    const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
    std::vector<char> buffer(1 << 16);
    while (in) {
        in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
        EVP_DigestUpdate(context.get(), buffer.data(), static_cast<std::size_t>(in.gcount()));
    }
    if (in.bad()) throw LogError(fmt::format("{}: cannot be read to compute its checksum", file));
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    EVP_DigestFinal_ex(context.get(), digest.data(), &length);
    std::string hex;
    for (unsigned int i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest[i]);
    return hex;
}

Checksum checkChecksum(const std::string& file) {
    std::ifstream in(file + ".sha256");
    std::string expected;
    if (!in) return Checksum::none;
    in >> expected;
    return expected == sha256OfFile(file) ? Checksum::matches : Checksum::differs;
}

}  // namespace slamot

#include "GzStream.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "slamot/rawlog/LogError.h"

namespace slamot {
namespace {

constexpr std::size_t chunk = 1 << 16;
constexpr unsigned char gz_magic[2] = {0x1f, 0x8b};

}  // namespace

GzReader::GzReader(const std::string& file) {
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status))
        throw LogError(fmt::format("{}: there is no such file, expected a rawlog", file));
    if (!std::filesystem::is_regular_file(status))
        throw LogError(fmt::format("{}: is no regular file, expected a rawlog", file));
    file_.reset(std::fopen(file.c_str(), "rb"));
    if (!file_)
        throw LogError(fmt::format("{}: cannot be opened ({}), expected a rawlog", file, std::strerror(errno)));
    file_size_ = std::filesystem::file_size(file, error);
    if (error || file_size_ == 0) throw LogError(fmt::format("{}: the file is empty, expected a rawlog", file));

    unsigned char magic[2] = {};
    const std::size_t got = std::fread(magic, 1, 2, file_.get());
    std::rewind(file_.get());
    compressed_ = got == 2 && std::equal(magic, magic + 2, gz_magic);
    input_.resize(chunk);
    constexpr int gz_format_only = 16 + MAX_WBITS;
    if (compressed_ && inflateInit2(&inflater_, gz_format_only) != Z_OK)
        throw LogError(fmt::format("{}: zlib cannot be started", file));
}

GzReader::~GzReader() {
    if (compressed_) inflateEnd(&inflater_);
}

void GzReader::finish(BytesEnd end, const std::string& trouble) {
    end_ = end;
    trouble_ = trouble;
}

double GzReader::progress() const {
    return std::min(1.0, static_cast<double>(file_read_ - inflater_.avail_in) / static_cast<double>(file_size_));
}

std::string_view GzReader::peek(std::size_t count) {
    while (output_.size() - output_begin_ < count && fill()) {
    }
    return std::string_view(output_).substr(output_begin_, count);
}

std::size_t GzReader::Read(void* Buffer, std::size_t Count) {
    auto* out = static_cast<char*>(Buffer);
    for (std::size_t done = 0; done < Count;) {
        if (output_begin_ == output_.size() && !fill()) {
            ran_out_ = true;
            throw std::runtime_error("the data ended");
        }
        const std::size_t part = std::min(Count - done, output_.size() - output_begin_);
        std::memcpy(out + done, output_.data() + output_begin_, part);
        output_begin_ += part;
        taken_ += part;
        done += part;
    }
    return Count;
}

/// Adds bytes to output_; false when there are none left.
bool GzReader::fill() {
    if (end_ != BytesEnd::not_yet) return false;
    output_.erase(0, output_begin_);
    output_begin_ = 0;
    const std::size_t before = output_.size();
    while (output_.size() == before && end_ == BytesEnd::not_yet) {
        if (inflater_.avail_in == 0) {
            const std::size_t got = std::fread(input_.data(), 1, input_.size(), file_.get());
            file_read_ += got;
            inflater_.next_in = input_.data();
            inflater_.avail_in = static_cast<uInt>(got);
            if (got == 0) {
                if (std::ferror(file_.get()))
                    finish(BytesEnd::corrupt, "the file cannot be read further");
                else if (compressed_ && !between_members_)
                    finish(BytesEnd::truncated, "the compressed data break off");
                else
                    finish(BytesEnd::clean, "");
                break;
            }
        }
        if (compressed_) {
            inflateSome();
        } else {
            output_.append(reinterpret_cast<const char*>(inflater_.next_in), inflater_.avail_in);
            inflater_.avail_in = 0;
        }
    }
    return output_.size() > before;
}

void GzReader::inflateSome() {
    if (between_members_) {
        // The second magic byte may lie in the next chunk; inflate itself checks it.
        if (*inflater_.next_in != gz_magic[0]) {
            finish(BytesEnd::corrupt, "there are foreign bytes after the end of the compressed data");
            return;
        }
        inflateReset(&inflater_);
        between_members_ = false;
    }
    const std::size_t before = output_.size();
    output_.resize(before + chunk);
    inflater_.next_out = reinterpret_cast<unsigned char*>(&output_[before]);
    inflater_.avail_out = static_cast<uInt>(chunk);
    const int result = inflate(&inflater_, Z_NO_FLUSH);
    output_.resize(before + chunk - inflater_.avail_out);
    if (result == Z_STREAM_END)
        between_members_ = true;
    else if (result != Z_OK && result != Z_BUF_ERROR)
        finish(BytesEnd::corrupt,
               fmt::format("the compressed data are damaged ({})", inflater_.msg ? inflater_.msg : "zlib error"));
}

std::size_t GzReader::Write(const void*, std::size_t) {
    throw std::logic_error("GzReader does not write");
}

std::uint64_t GzReader::Seek(std::int64_t, TSeekOrigin) {
    throw std::runtime_error("GzReader only goes forward");
}

GzWriter::GzWriter(const std::string& file) : file_(file) {
    handle_ = gzopen(file.c_str(), "wb");
    if (!handle_) throw LogError(fmt::format("{}: cannot be written ({})", file, std::strerror(errno)));
}

GzWriter::~GzWriter() {
    if (handle_) gzclose(handle_);
}

std::size_t GzWriter::Write(const void* Buffer, std::size_t Count) {
    if (gzfwrite(Buffer, 1, Count, handle_) != Count)
        throw LogError(fmt::format("{}: cannot be written ({})", file_, std::strerror(errno)));
    written_ += Count;
    return Count;
}

void GzWriter::close() {
    const gzFile handle = handle_;
    handle_ = nullptr;
    if (handle && gzclose(handle) != Z_OK)
        throw LogError(fmt::format("{}: cannot be written to its end ({})", file_, std::strerror(errno)));
}

std::size_t GzWriter::Read(void*, std::size_t) {
    throw std::logic_error("GzWriter does not read");
}

std::uint64_t GzWriter::Seek(std::int64_t, TSeekOrigin) {
    throw std::logic_error("GzWriter only goes forward");
}

}  // namespace slamot

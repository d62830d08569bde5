#pragma once
// Byte streams under a rawlog. MRPT's own gz streams cannot tell the end of a file from a broken one and do not say
// when a checksum is wrong, so these stand on zlib directly.
#include <mrpt/io/CStream.h>
#include <zlib.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace slamot {

/// Where the bytes of a file end.
enum class BytesEnd { not_yet, clean, truncated, corrupt };

/// Reads a gz-compressed or a plain file front to back.
class GzReader : public mrpt::io::CStream {
   public:
    /// Throws LogError for a file that is missing, no regular file, or empty.
    explicit GzReader(const std::string& file);
    ~GzReader() override;
    GzReader(const GzReader&) = delete;
    GzReader& operator=(const GzReader&) = delete;

    /// The next `count` bytes, fewer at the end, without taking them.
    std::string_view peek(std::size_t count);
    /// All `Count` bytes, or an exception: objects are never built from half their bytes.
    std::size_t Read(void* Buffer, std::size_t Count) override;

    /// Known once `peek` or `Read` met the end.
    BytesEnd end() const { return end_; }
    /// Whether a Read asked for more than there was.
    bool ranOut() const { return ran_out_; }
    /// What is wrong, for BytesEnd::truncated and corrupt.
    const std::string& trouble() const { return trouble_; }
    /// Bytes of the uncompressed stream taken so far.
    std::uint64_t getPosition() const override { return taken_; }
    /// Part of the file read, 0 to 1.
    double progress() const;

    std::size_t Write(const void*, std::size_t) override;
    std::uint64_t Seek(std::int64_t, TSeekOrigin) override;
    std::uint64_t getTotalBytesCount() const override { return file_size_; }

   private:
    bool fill();
    void inflateSome();
    void finish(BytesEnd end, const std::string& trouble);

    struct FileCloser {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::unique_ptr<std::FILE, FileCloser> file_;
    std::uint64_t file_size_ = 0, file_read_ = 0, taken_ = 0;
    bool compressed_ = false, between_members_ = true, ran_out_ = false;
    BytesEnd end_ = BytesEnd::not_yet;
    std::string trouble_;
    z_stream inflater_{};
    std::vector<unsigned char> input_;
    std::string output_;           ///< uncompressed bytes
    std::size_t output_begin_ = 0;  ///< those before are taken
};

/// Writes a gz-compressed file. Throws LogError when the disk does not take it.
class GzWriter : public mrpt::io::CStream {
   public:
    explicit GzWriter(const std::string& file);
    ~GzWriter() override;
    GzWriter(const GzWriter&) = delete;
    GzWriter& operator=(const GzWriter&) = delete;

    std::size_t Write(const void* Buffer, std::size_t Count) override;
    void close();

    std::size_t Read(void*, std::size_t) override;
    std::uint64_t Seek(std::int64_t, TSeekOrigin) override;
    std::uint64_t getPosition() const override { return written_; }
    std::uint64_t getTotalBytesCount() const override { return written_; }

   private:
    std::string file_;
    gzFile handle_ = nullptr;
    std::uint64_t written_ = 0;
};

}  // namespace slamot

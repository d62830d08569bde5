#include "slamot/rawlog/RawlogWriter.h"

#include <fmt/format.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>
#include <fstream>

#include "GzStream.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/PartFile.h"

namespace slamot {

namespace fs = std::filesystem;

struct RawlogWriter::Impl {
    explicit Impl(const std::string& name) : file(name), bytes(partOf(name)) {}

    void write(const mrpt::serialization::CSerializable& object) {
        auto archive = mrpt::serialization::archiveFrom(bytes);
        archive << object;
    }

    std::string file;
    GzWriter bytes;
};

RawlogWriter::RawlogWriter(const std::string& file) {
    if (const fs::path folder = fs::path(file).parent_path(); !folder.empty() && !fs::is_directory(folder))
        throw LogError(fmt::format("{}: cannot be written, there is no folder {}", file, folder.string()));
    impl_ = std::make_unique<Impl>(file);
}
RawlogWriter::~RawlogWriter() = default;

void RawlogWriter::write(const mrpt::obs::CObservation& observation) {
    impl_->write(observation);
}

void RawlogWriter::writeFrame(const mrpt::obs::CActionCollection& action,
                              const mrpt::obs::CSensoryFrame& observations) {
    impl_->write(action);
    impl_->write(observations);
}

void RawlogWriter::writeAction(const mrpt::obs::CActionCollection& action) {
    impl_->write(action);
}

void RawlogWriter::close() {
    impl_->bytes.close();
    // The old checksum goes first, so that a crash in between leaves a log without one, not with a wrong one.
    const std::string checksum_file = impl_->file + ".sha256";
    std::error_code error;
    fs::remove(checksum_file, error);
    finishPart(impl_->file);
    std::ofstream out(checksum_file);
    out << sha256OfFile(impl_->file) << "  " << fs::path(impl_->file).filename().string() << '\n';
    out.close();
    if (!out) throw LogError(fmt::format("{}: cannot be written", checksum_file));
}

}  // namespace slamot

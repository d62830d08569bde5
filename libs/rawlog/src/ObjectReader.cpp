#include "ObjectReader.h"

#include <fmt/format.h>
#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/registerAllClasses.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cctype>
#include <new>

#include "slamot/rawlog/LogError.h"

namespace slamot {
namespace {

constexpr std::size_t longest_class_name = 120;  // MRPT's limit

/// The class name in front of an object: a byte 0x80 + length and the name, or, before MRPT 0.5.5, the length as
/// four bytes and the name. Nothing when the bytes are no such header; empty when they break off within it.
std::optional<std::string> peekClassName(GzReader& bytes) {
    const auto isNameCharacter = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == ':'; };
    const std::string first(bytes.peek(1));
    const auto mark = static_cast<unsigned char>(first[0]);
    const bool old = !(mark & 0x80);
    const std::size_t length = mark & 0x7f, header = old ? 4 : 1;
    if (length == 0 || length > longest_class_name) return std::nullopt;
    const std::string_view all = bytes.peek(header + length);
    if (old && all.substr(1, 3) != std::string_view("\0\0\0", std::min<std::size_t>(3, all.size() - 1)))
        return std::nullopt;
    const std::string_view name = all.substr(std::min(header, all.size()));
    if (!std::all_of(name.begin(), name.end(), isNameCharacter)) return std::nullopt;
    return all.size() < header + length ? std::string() : std::string(name);
}

void registerLogClasses() {
    mrpt::obs::registerAllClasses_mrpt_obs();
    mrpt::maps::registerAllClasses_mrpt_maps();
}

}  // namespace

ObjectReader::ObjectReader(const std::string& file) : file_(file), bytes_(file) {
    registerLogClasses();
    if (bytes_.peek(1).empty()) {
        if (bytes_.end() == BytesEnd::clean)
            throw LogError(fmt::format("{}: holds no data, expected a rawlog", file));
        throw LogError(fmt::format("{}: nothing can be read, {}; expected a rawlog", file, bytes_.trouble()));
    }
    if (!peekClassName(bytes_))
        throw LogError(fmt::format("{}: is no rawlog, since it does not start with an MRPT object", file));
}

std::optional<LogObject> ObjectReader::next() {
    while (unpacked_.empty()) {
        const auto object = read();
        if (!object) return std::nullopt;
        const auto whole_log = std::dynamic_pointer_cast<mrpt::obs::CRawlog>(object);
        if (!whole_log) {
            unpacked_.push_back(object);
            continue;
        }
        for (std::size_t i = 0; i < whole_log->size(); ++i)
            if (auto entry = whole_log->getAsGeneric(i)) unpacked_.push_back(entry);
    }
    LogObject result{unpacked_.front(), count_++};
    unpacked_.pop_front();
    return result;
}

mrpt::serialization::CSerializable::Ptr ObjectReader::read() {
    if (end_ != LogEnd::not_yet) return nullptr;
    object_begin_ = bytes_.getPosition();
    if (bytes_.peek(1).empty()) {
        if (bytes_.end() == BytesEnd::clean) {
            end_ = LogEnd::clean;
        } else {
            finish(bytes_.end() == BytesEnd::truncated ? LogEnd::truncated : LogEnd::corrupt,
                   bytes_.trouble() + " before");
        }
        return nullptr;
    }
    const auto name = peekClassName(bytes_);
    if (!name) {
        finish(LogEnd::corrupt, "no MRPT object starts where one should, at");
        return nullptr;
    }
    if (name->empty()) {
        if (bytes_.end() == BytesEnd::corrupt)
            finish(LogEnd::corrupt, bytes_.trouble() + " in");
        else
            finish(LogEnd::truncated, "the log breaks off within");
        return nullptr;
    }
    if (*name != "nullptr" && !mrpt::rtti::findRegisteredClass(*name)) {
        finish(LogEnd::corrupt, fmt::format("unknown class '{}' (objects carry no length, so what follows cannot be "
                                            "read) at",
                                            *name));
        return nullptr;
    }
    try {
        auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(bytes_));
        if (auto object = archive.ReadObject()) return object;
        finish(LogEnd::corrupt, "an empty object stands at");
    } catch (const std::bad_alloc&) {
        finish(LogEnd::corrupt, fmt::format("a '{}' asks for more memory than there is, at", *name));
    } catch (const std::exception&) {
        // MRPT reports every failure within an object as an end of file; the bytes know better.
        if (bytes_.ranOut() && bytes_.end() == BytesEnd::corrupt)
            finish(LogEnd::corrupt, bytes_.trouble() + " in");
        else if (bytes_.ranOut())
            finish(LogEnd::truncated, fmt::format("the log breaks off within a '{}',", *name));
        else
            finish(LogEnd::corrupt, fmt::format("the data of a '{}' make no sense at", *name));
    }
    return nullptr;
}

void ObjectReader::finish(LogEnd end, const std::string& what) {
    end_ = end;
    end_message_ =
        fmt::format("{}: {} object {} (byte {} of the uncompressed data)", file_, what, count_, object_begin_);
}

}  // namespace slamot

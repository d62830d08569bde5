#pragma once
// The objects of a rawlog file one after the other, whatever they are.
#include <mrpt/serialization/CSerializable.h>

#include <deque>
#include <optional>
#include <string>

#include "GzStream.h"
#include "slamot/rawlog/RawlogReader.h"

namespace slamot {

struct LogObject {
    mrpt::serialization::CSerializable::Ptr object;
    std::int64_t position = 0;  ///< number in the file, from 0
};

class ObjectReader {
   public:
    /// Throws LogError for a file that is missing, empty or no rawlog.
    explicit ObjectReader(const std::string& file);

    /// The next object, or nothing at the end. A `CRawlog` object (how whole logs were saved once) gives its entries.
    std::optional<LogObject> next();

    LogEnd end() const { return end_; }
    const std::string& endMessage() const { return end_message_; }
    std::int64_t objects() const { return count_; }
    double progress() const { return bytes_.progress(); }

   private:
    mrpt::serialization::CSerializable::Ptr read();
    void finish(LogEnd end, const std::string& what);

    std::string file_;
    GzReader bytes_;
    std::deque<mrpt::serialization::CSerializable::Ptr> unpacked_;
    std::int64_t count_ = 0;
    std::uint64_t object_begin_ = 0;
    LogEnd end_ = LogEnd::not_yet;
    std::string end_message_;
};

}  // namespace slamot

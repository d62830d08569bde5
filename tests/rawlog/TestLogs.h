#pragma once
// Small logs made by hand, shared by the tests of libs/rawlog.
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/serialization/CArchive.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "slamot/rawlog/Conventions.h"
#include "slamot/rawlog/RawlogReader.h"
#include "slamot/rawlog/RawlogWriter.h"
#include "support/TemporaryFolder.h"

namespace slamot::test {

/// A folder of the running test, removed at its end.
class RawlogTest : public ::testing::Test {
  protected:
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

  private:
    const TemporaryFolder temporary_;

  protected:
    const std::filesystem::path folder_ = temporary_.path();
};

inline void writeBytes(const std::string& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

inline std::string readBytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// An object as it stands in an uncompressed log.
inline std::string bytesOf(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream memory;
    auto archive = mrpt::serialization::archiveFrom(memory);
    archive << object;
    return {static_cast<const char*>(memory.getRawBufferData()), memory.getTotalBytesCount()};
}

inline mrpt::obs::CObservationOdometry::Ptr odometryAt(double t, double x,
                                                       const std::string& label = "odometry") {
    return toMrpt(OdometryReading{Stamp::fromSeconds(t), {x, 0, 0}, BodyVelocity{1, 0, 0.5}}, label);
}

inline mrpt::obs::CObservationBearingRange::Ptr detectionsAt(double t, const std::string& label,
                                                             const std::vector<std::int64_t>& ids) {
    RangeBearingReading reading;
    reading.stamp = Stamp::fromSeconds(t);
    reading.sensor.label = label;
    for (const auto id : ids) {
        RangeBearingReading::Item item;
        item.range = 2 + static_cast<double>(id);
        item.bearing = 0.25;
        item.id = SourceId{id};
        reading.items.push_back(item);
    }
    return toMrpt(reading, 0.5, 0.125);
}

inline mrpt::obs::CObservation2DRangeScan::Ptr scanAt(double t, const std::string& label = "laser") {
    auto scan = mrpt::obs::CObservation2DRangeScan::Create();
    scan->timestamp = toMrpt(Stamp::fromSeconds(t));
    scan->sensorLabel = label;
    scan->resizeScan(3);
    for (int i = 0; i < 3; ++i) {
        scan->setScanRange(i, 1.0f);
        scan->setScanRangeValidity(i, true);
    }
    return scan;
}

inline void writeLog(const std::string& file, const std::vector<mrpt::obs::CObservation::Ptr>& observations) {
    RawlogWriter writer(file);
    for (const auto& observation : observations) writer.write(*observation);
    writer.close();
}

struct ReadLog {
    std::vector<LogEntry> entries;
    LogFormat format;
    LogEnd end;
    std::string end_message;
    DropTable drops;
};

inline ReadLog readLog(const std::string& file, const LogParameters& parameters = {}) {
    RawlogReader reader(file, parameters);
    ReadLog log;
    while (auto entry = reader.next()) log.entries.push_back(*entry);
    log.format = reader.format();
    log.end = reader.end();
    log.end_message = reader.endMessage();
    log.drops = reader.drops();
    return log;
}

}  // namespace slamot::test

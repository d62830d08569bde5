// Logs that are cut, changed or no logs at all.
#include <gmock/gmock.h>

#include <set>

#include "rawlog/TestLogs.h"
#include "slamot/rawlog/LogCheck.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::test {
namespace broken_log_test {

using ::testing::HasSubstr;

class BrokenLog : public RawlogTest {
  protected:
    std::string messageOf(const std::string& name) const {
        try {
            readLog(path(name));
        } catch (const LogError& error) {
            return error.what();
        }
        return "no LogError";
    }
    LogSummary check(const std::string& name) const {
        return summariseInChild(SLAMOT_CHECK_LOG_HELPER, path(name), {});
    }
};

std::vector<mrpt::obs::CObservation::Ptr> smallLog() {
    return {odometryAt(1, 0), scanAt(1.5), detectionsAt(2, "landmarks", {1, 2}), odometryAt(3, 1)};
}

TEST_F(BrokenLog, FilesThatAreNoRawlogsGiveASentence) {
    EXPECT_THAT(messageOf("none.rawlog"), HasSubstr("no such file"));
    std::filesystem::create_directories(path("folder"));
    EXPECT_THAT(messageOf("folder"), HasSubstr("no regular file"));
    writeBytes(path("empty.rawlog"), "");
    EXPECT_THAT(messageOf("empty.rawlog"), HasSubstr("is empty"));
    for (const char* junk : {"t,x,y\n1,2,3\n", "\x89PNG\r\n\x1a\n", "\x81 ", "\x7f", "x"}) {
        writeBytes(path("junk.rawlog"), junk);
        EXPECT_THAT(messageOf("junk.rawlog"), HasSubstr("is no rawlog")) << junk;
    }
    RawlogWriter(path("nothing.rawlog")).close();
    EXPECT_THAT(messageOf("nothing.rawlog"), HasSubstr("holds no data"));
}

TEST_F(BrokenLog, AGzLogCutAnywhereIsNeverClean) {
    writeLog(path("a.rawlog"), smallLog());
    const std::string whole = readBytes(path("a.rawlog"));
    ASSERT_EQ(readLog(path("a.rawlog")).end, LogEnd::clean);
    for (std::size_t n = 0; n < whole.size(); ++n) {
        writeBytes(path("cut.rawlog"), whole.substr(0, n));
        try {
            const ReadLog log = readLog(path("cut.rawlog"));
            EXPECT_EQ(log.end, LogEnd::truncated) << n << " bytes: " << log.end_message;
            EXPECT_THAT(log.end_message, HasSubstr("object")) << n;
        } catch (const LogError&) {  // nothing at all could be read
        }
    }
}

TEST_F(BrokenLog, AnUncompressedLogCutWithinAnObjectIsNeverClean) {
    std::string whole;
    std::set<std::size_t> boundaries;
    const std::size_t first_header = 1 + std::string("mrpt::obs::CObservationOdometry").size();
    for (const auto& observation : smallLog()) {
        whole += bytesOf(*observation);
        boundaries.insert(whole.size());
    }
    for (std::size_t n = 1; n <= whole.size(); ++n) {
        writeBytes(path("cut.rawlog"), whole.substr(0, n));
        if (n < first_header) {
            EXPECT_THAT(messageOf("cut.rawlog"), HasSubstr("is no rawlog"));
            continue;
        }
        const ReadLog log = readLog(path("cut.rawlog"));
        // At a boundary nothing shows the cut: only a checksum beside the log would.
        EXPECT_EQ(log.end, boundaries.count(n) ? LogEnd::clean : LogEnd::truncated) << n << log.end_message;
        const auto complete = std::distance(boundaries.begin(), boundaries.upper_bound(n));
        EXPECT_EQ(log.entries.size(), static_cast<std::size_t>(complete)) << n;
    }
}

TEST_F(BrokenLog, TheMessageNamesObjectAndByte) {
    const std::string first = bytesOf(*odometryAt(1, 0));
    writeBytes(path("a.rawlog"), first + bytesOf(*scanAt(2)).substr(0, 50));
    EXPECT_THAT(readLog(path("a.rawlog")).end_message,
                HasSubstr("within a 'mrpt::obs::CObservation2DRangeScan', object 1 (byte " +
                          std::to_string(first.size())));
}

TEST_F(BrokenLog, AnUnknownClassEndsTheLog) {
    std::string alien = bytesOf(*scanAt(2));
    alien.replace(alien.find("CObservation2DRangeScan"), 23, "CObservation9DRangeScan");
    writeBytes(path("a.rawlog"), bytesOf(*odometryAt(1, 0)) + alien + bytesOf(*odometryAt(3, 0)));
    const ReadLog log = readLog(path("a.rawlog"));
    EXPECT_EQ(log.entries.size(), 1u);
    EXPECT_EQ(log.end, LogEnd::corrupt);
    EXPECT_THAT(log.end_message, HasSubstr("unknown class 'mrpt::obs::CObservation9DRangeScan'"));
    EXPECT_THAT(log.end_message, HasSubstr("object 1 "));
}

TEST_F(BrokenLog, JunkBetweenObjectsIsCorruption) {
    writeBytes(path("a.rawlog"), bytesOf(*odometryAt(1, 0)) + "junk" + bytesOf(*odometryAt(3, 0)));
    EXPECT_EQ(readLog(path("a.rawlog")).end, LogEnd::corrupt);
    writeLog(path("b.rawlog"), smallLog());
    writeBytes(path("b.rawlog"), readBytes(path("b.rawlog")) + "junk");
    const ReadLog trailing = readLog(path("b.rawlog"));
    EXPECT_EQ(trailing.end, LogEnd::corrupt);
    EXPECT_EQ(trailing.entries.size(), 4u);
}

TEST_F(BrokenLog, GzMembersOneAfterTheOtherAreOneLog) {
    writeLog(path("a.rawlog"), {odometryAt(1, 0)});
    writeLog(path("b.rawlog"), {odometryAt(2, 0)});
    writeBytes(path("both.rawlog"), readBytes(path("a.rawlog")) + readBytes(path("b.rawlog")));
    const ReadLog log = readLog(path("both.rawlog"));
    EXPECT_EQ(log.entries.size(), 2u);
    EXPECT_EQ(log.end, LogEnd::clean);
}

/// Every bit of a gz file that carries data is covered by its checksum. Bytes 4 to 9 of the header (time,
/// level, system) carry none: RFC 1952, 2.3.1. Nor does the lowest flag of byte 3, 'probably text'.
bool carriesData(std::size_t byte, int bit) {
    return !(byte >= 4 && byte < 10) && !(byte == 3 && bit == 0);
}

TEST_F(BrokenLog, FlippedBitsOfAGzLogAreReportedAndNeverKillTheParent) {
    writeLog(path("a.rawlog"), smallLog());
    const std::string whole = readBytes(path("a.rawlog"));
    // One bit of every fifth byte, each in turn: all bits of all bytes would start some thousands of
    // processes.
    for (std::size_t byte = 0; byte < whole.size(); byte += 5) {
        const int bit = static_cast<int>(byte % 8);
        std::string flipped = whole;
        flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << bit));
        writeBytes(path("flipped.rawlog"), flipped);
        try {
            const LogSummary summary = check("flipped.rawlog");
            EXPECT_EQ(summary.end == LogEnd::clean, !carriesData(byte, bit))
                << "bit " << bit << " of byte " << byte;
        } catch (const LogError& error) {  // not even its first object can be told
            EXPECT_THAT(error.what(), HasSubstr("expected a rawlog")) << "bit " << bit << " of byte " << byte;
        }
    }
}

TEST_F(BrokenLog, FlippedBitsOfAnUncompressedLogNeverKillTheParent) {
    std::string whole;
    for (const auto& observation : smallLog()) whole += bytesOf(*observation);
    for (std::size_t byte = 0; byte < whole.size(); byte += 23) {
        std::string flipped = whole;
        flipped[byte] = static_cast<char>(flipped[byte] ^ 0x40);
        writeBytes(path("flipped.rawlog"), flipped);
        try {
            check("flipped.rawlog");  // a changed number cannot be told: any answer is right
        } catch (const LogError& error) {
            EXPECT_THAT(error.what(), HasSubstr("flipped.rawlog"));
        }
    }
}

TEST_F(BrokenLog, AnAbsurdSizeIsCorruption) {
    std::string scan = bytesOf(*scanAt(2));
    // The number of rays, 3 as four bytes, comes after the 1.0f ranges' count; look for it and enlarge it.
    const std::string three("\3\0\0\0", 4);
    const auto place = scan.find(three);
    ASSERT_NE(place, std::string::npos);
    scan.replace(place, 4, std::string("\xff\xff\xff\x7f", 4));
    writeBytes(path("a.rawlog"), bytesOf(*odometryAt(1, 0)) + scan);
    const LogSummary summary = check("a.rawlog");
    EXPECT_NE(summary.end, LogEnd::clean);
    EXPECT_FALSE(summary.end_message.empty());
}

}  // namespace broken_log_test
}  // namespace slamot::test

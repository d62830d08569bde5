#include "rawlog/TestLogs.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/rawlog/RawlogWriter.h"

namespace slamot::test {
namespace rawlog_writer_test {

class Writer : public RawlogTest {};

TEST_F(Writer, TheFileAppearsOnlyWhenItIsWhole) {
    {
        RawlogWriter writer(path("a.rawlog"));
        writer.write(*odometryAt(1, 0));
        EXPECT_FALSE(std::filesystem::exists(path("a.rawlog")));
        EXPECT_TRUE(std::filesystem::exists(path("a.rawlog.part")));
    }
    EXPECT_FALSE(std::filesystem::exists(path("a.rawlog")));  // never closed
    writeLog(path("a.rawlog"), {odometryAt(1, 0)});
    EXPECT_TRUE(std::filesystem::exists(path("a.rawlog")));
    EXPECT_FALSE(std::filesystem::exists(path("a.rawlog.part")));
}

TEST_F(Writer, ChecksumTellsTampering) {
    writeLog(path("a.rawlog"), {odometryAt(1, 0)});
    EXPECT_EQ(checkChecksum(path("a.rawlog")), Checksum::matches);
    EXPECT_EQ(readBytes(path("a.rawlog.sha256")), sha256OfFile(path("a.rawlog")) + "  a.rawlog\n");
    writeBytes(path("a.rawlog"), readBytes(path("a.rawlog")) + "x");
    EXPECT_EQ(checkChecksum(path("a.rawlog")), Checksum::differs);
    std::filesystem::remove(path("a.rawlog.sha256"));
    EXPECT_EQ(checkChecksum(path("a.rawlog")), Checksum::none);
}

TEST_F(Writer, Sha256OfAKnownText) {
    writeBytes(path("abc"), "abc");  // FIPS 180-4, example of one block
    EXPECT_EQ(sha256OfFile(path("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(Writer, EqualLogsAreEqualBytes) {
    writeLog(path("a.rawlog"), {odometryAt(1, 0), detectionsAt(2, "landmarks", {1, 2})});
    writeLog(path("b.rawlog"), {odometryAt(1, 0), detectionsAt(2, "landmarks", {1, 2})});
    EXPECT_EQ(readBytes(path("a.rawlog")), readBytes(path("b.rawlog")));
}

TEST_F(Writer, AFolderThatIsNotThereIsNamed) {
    EXPECT_THROW(RawlogWriter(path("none/a.rawlog")), LogError);
    std::filesystem::create_directories(path("b.rawlog.part"));
    EXPECT_THROW(RawlogWriter(path("b.rawlog")), LogError);
}

}  // namespace rawlog_writer_test
}  // namespace slamot::test

#include <mrpt/io/CFileGZInputStream.h>

#include <thread>

#include "TestLogs.h"
#include "slamot/rawlog/GzFile.h"
#include "slamot/rawlog/LogError.h"

namespace slamot::test {
namespace gz_file_test {

class GzFile : public RawlogTest {
  protected:
    double positionIn(const std::string& file) const {
        mrpt::io::CFileGZInputStream in(file);
        mrpt::obs::CObservationOdometry odometry;
        mrpt::serialization::archiveFrom(in) >> odometry;
        return odometry.odometry.x();
    }
};

// Whole programs and threads write at once: each file must hold its own object.
TEST_F(GzFile, ManyAtOnceDoNotMix) {
    std::vector<std::thread> writers;
    for (int w = 0; w < 4; ++w)
        writers.emplace_back([this, w] {
            for (int k = 0; k < 100; ++k)
                writeGzFile(*odometryAt(1, 1000 * w + k), path(std::to_string(w) + "_" + std::to_string(k)));
        });
    for (std::thread& writer : writers) writer.join();
    for (int w = 0; w < 4; ++w)
        for (int k = 0; k < 100; ++k)
            ASSERT_EQ(positionIn(path(std::to_string(w) + "_" + std::to_string(k))), 1000 * w + k);
}

TEST_F(GzFile, RefusesWhereNothingCanBeWritten) {
    EXPECT_THROW(writeGzFile(*odometryAt(1, 0), path("no folder/file")), LogError);
}

}  // namespace gz_file_test
}  // namespace slamot::test

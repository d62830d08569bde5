#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/slam/CRangeBearingKFSLAM2D.h>

#include <optional>
#include <stdexcept>
#include <utility>

#include "StepClock.h"
#include "Trial.h"

namespace slamot::bench {
namespace {

using Frame = std::pair<mrpt::obs::CActionCollection::Ptr, mrpt::obs::CSensoryFrame::Ptr>;

/// What a log shows before its first action: taken where the run starts. kf-slam's own reader skips it; slamot uses
/// it, so it is given to both, as a frame after an action without movement.
std::optional<Frame> frameAtTheStart(const std::string& log) {
    mrpt::io::CFileGZInputStream file(log);
    auto archive = mrpt::serialization::archiveFrom(file);
    const auto first = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(archive.ReadObject());
    if (!first) return std::nullopt;
    return Frame{mrpt::obs::CActionCollection::Create(), first};
}

/// Pairs of action and the sensory frame after it, by the function kf-slam itself reads with.
std::vector<Frame> readFrames(const std::string& log) {
    mrpt::io::CFileGZInputStream file(log);
    auto archive = mrpt::serialization::archiveFrom(file);
    std::vector<Frame> frames;
    std::size_t entry = 0;
    for (Frame frame;
         mrpt::obs::CRawlog::readActionObservationPair(archive, frame.first, frame.second, entry); frame = {})
        frames.push_back(frame);
    if (frames.empty()) throw std::runtime_error(log + ": no pair of action and sensory frame");
    return frames;
}

}  // namespace

Trial runKfSlam(const std::string& log, const SensorNoise& noise) {
    std::vector<Frame> frames = readFrames(log);
    mrpt::slam::CRangeBearingKFSLAM2D filter;
    filter.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    filter.options.std_sensor_range = static_cast<float>(noise.range_std);
    filter.options.std_sensor_yaw = static_cast<float>(noise.bearing_std);

    if (auto start = frameAtTheStart(log)) filter.processActionObservation(start->first, start->second);

    Trial trial;
    for (Frame& frame : frames) {
        const double begin = threadSeconds();
        filter.processActionObservation(frame.first, frame.second);
        trial.seconds.push_back(threadSeconds() - begin);

        mrpt::poses::CPosePDFGaussian pose;
        filter.getCurrentRobotPose(pose);
        trial.poses.push_back({pose.mean.x(), pose.mean.y(), pose.mean.phi()});
        trial.landmarks.push_back(static_cast<int>((filter.getStateVectorLength() - 3) / 2));
        const auto seen = frame.second->getObservationByClass<mrpt::obs::CObservationBearingRange>();
        trial.seen.push_back(seen ? static_cast<int>(seen->sensedData.size()) : 0);
    }
    return trial;
}

}  // namespace slamot::bench

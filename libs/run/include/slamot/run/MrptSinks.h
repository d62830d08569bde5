#pragma once
// Sinks for files that MRPT's own programs open.
#include <memory>
#include <string>
#include <vector>

#include "slamot/rawlog/RawlogWriter.h"
#include "slamot/run/Sink.h"

namespace slamot::run {

/// map.landmarks.gz: a mrpt::maps::CLandmarksMap.
class LandmarkMapSink : public Sink {
   public:
    explicit LandmarkMapSink(std::string folder) : folder_(std::move(folder)) {}
    void step(const Step&) override {}
    void end(const RunEnd& end) override;

   private:
    std::string folder_;
};

/// scene.3Dscene for SceneViewer3D: trajectory, tracks, landmarks with 3-sigma ellipses, the robot at the end.
class SceneSink : public Sink {
   public:
    explicit SceneSink(std::string folder);
    ~SceneSink() override;
    void step(const Step& step) override;
    void end(const RunEnd& end) override;

   private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// estimate.rawlog: the log's observations with the robot's and the tracks' poses added as CObservationRobotPose
/// (labels slamot_robot, slamot_track_<id>) wherever detections were taken in.
class EstimateLogSink : public Sink {
   public:
    explicit EstimateLogSink(const std::string& folder);
    void observation(const mrpt::obs::CObservation& observation) override { writer_.write(observation); }
    void step(const Step& step) override;
    void end(const RunEnd&) override { writer_.close(); }

   private:
    RawlogWriter writer_;
};

/// correlation.bin: the final correlation matrix, down-sampled to at most 512 x 512 by taking the strongest value of
/// each cell. Bytes: "SLAMCORR", then little-endian uint32 version 1, dimension, rows n, then n*n float32 by rows.
class CorrelationSink : public Sink {
   public:
    explicit CorrelationSink(std::string folder) : folder_(std::move(folder)) {}
    void step(const Step&) override {}
    void end(const RunEnd& end) override;

   private:
    std::string folder_;
};

}  // namespace slamot::run

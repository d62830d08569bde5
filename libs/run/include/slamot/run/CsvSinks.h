#pragma once
// The CSV files of an output folder, one sink each; doc/output_files.md has the columns.
#include <optional>

#include "slamot/rawlog/PartFile.h"
#include "slamot/run/Sink.h"

namespace slamot::run {

/// Which steps get a row: all, or those with detections and otherwise one per `interval` seconds.
class RowClock {
  public:
    explicit RowClock(double interval) : interval_(interval) {}
    bool due(const Step& step);

  private:
    double interval_;
    std::optional<Stamp> last_;
};

/// trajectory.csv and trajectory.tum
class TrajectorySink : public Sink {
  public:
    TrajectorySink(const std::string& folder, double interval);
    void step(const Step& step) override;
    void end(const RunEnd& end) override;

  private:
    RowClock clock_;
    PartFile csv_, tum_;
};

/// tracks.csv
class TracksSink : public Sink {
  public:
    TracksSink(const std::string& folder, double interval, const std::vector<std::string>& mode_names);
    void step(const Step& step) override;
    void end(const RunEnd& end) override;

  private:
    RowClock clock_;
    PartFile csv_;
};

/// landmarks.csv, at the end
class LandmarksSink : public Sink {
  public:
    explicit LandmarksSink(const std::string& folder) : folder_(folder) {}
    void step(const Step&) override {}
    void end(const RunEnd& end) override;

  private:
    std::string folder_;
};

/// landmarks_history.csv: every landmark at every stamp that saw it
class LandmarksHistorySink : public Sink {
  public:
    explicit LandmarksHistorySink(const std::string& folder);
    void step(const Step& step) override;
    void end(const RunEnd&) override { csv_.close(); }

  private:
    PartFile csv_;
};

/// tentative.csv: what may turn out to be a landmark, at the rows of the trajectory
class TentativeSink : public Sink {
  public:
    TentativeSink(const std::string& folder, double interval);
    void step(const Step& step) override;
    void end(const RunEnd&) override { csv_.close(); }

  private:
    RowClock clock_;
    PartFile csv_;
};

/// particles.csv: at the rows of the trajectory, at most so many at each
class ParticlesSink : public Sink {
  public:
    ParticlesSink(const std::string& folder, double interval, int most);
    void step(const Step& step) override;
    void end(const RunEnd&) override { csv_.close(); }

  private:
    RowClock clock_;
    int most_;
    PartFile csv_;
};

/// innovations.csv
class InnovationsSink : public Sink {
  public:
    explicit InnovationsSink(const std::string& folder);
    void step(const Step& step) override;
    void end(const RunEnd&) override { csv_.close(); }

  private:
    PartFile csv_;
};

/// steps.csv
class StepsSink : public Sink {
  public:
    explicit StepsSink(const std::string& folder);
    void step(const Step& step) override;
    void end(const RunEnd&) override { csv_.close(); }

  private:
    PartFile csv_;
};

}  // namespace slamot::run

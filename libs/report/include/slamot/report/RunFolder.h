#pragma once
// What a run left in its output folder (doc/output_files.md), read again: all that its report is made from.
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "slamot/eval/Options.h"
#include "slamot/eval/RunRecord.h"
#include "slamot/eval/Trajectory.h"
#include "slamot/rawlog/Truth.h"

namespace slamot::report {

/// A row of steps.csv.
struct StepRow {
    Stamp stamp;
    std::int64_t landmarks = 0, tracks = 0;
    double predict_ms = 0, detect_ms = 0, update_ms = 0;
};

/// A row of landmarks_history.csv: a landmark after an update that saw it. Or one of tentative.csv: what may be one.
struct LandmarkSight {
    Stamp stamp;
    LandmarkId id;
    SourceId source;
    Vector2 mean = Vector2::Zero();
    Matrix2 covariance = Matrix2::Zero();
    double existence = 1.0;
};

/// The rows of particles.csv at one stamp.
struct ParticleSet {
    struct Row {
        std::int64_t number = 0;  ///< in the filter
        double weight = 0;        ///< they sum to 1
        Pose2 pose;
    };
    Stamp stamp;
    std::vector<Row> rows;
};

/// correlation.bin
struct CorrelationCells {
    int dimension = 0;      ///< of the whole matrix
    Eigen::MatrixXf cells;  ///< square; down-sampled where it is smaller than the whole
};

/// Files that are absent (switched off in `[output]`) leave their part empty.
struct RunFolder {
    std::string folder;
    nlohmann::json summary;
    std::string log_file;  ///< where the log is; what the run called it where it is gone
    eval::EvaluationOptions evaluation;  ///< how the run was evaluated, or would be
    eval::RunRecord run;
    bool map_known = false;  ///< landmarks.csv is the final map: what is not in it has left
    std::vector<LandmarkSight> sights;
    std::vector<LandmarkSight> tentative;  ///< all there were at each stamp of the trajectory
    std::vector<ParticleSet> particles;    ///< by stamp, rising
    std::vector<StepRow> steps;
    std::optional<CorrelationCells> correlation;
    std::optional<Truth> truth;
    std::string truth_folder;  ///< where it was read
    std::string why_no_truth;  ///< a clause, where there is none
    bool lost_truth = false;   ///< the run had one, which is gone or broken

    /// The robot's poses with their truth; none without truth.
    std::vector<eval::PosePair> pairs;

    /// The estimator came to an impossible state: there is no final map.
    bool failed() const { return text("status") == "failed"; }
    /// Since the start of the run.
    double seconds(Stamp stamp) const;
    double duration() const;
    /// A number of summary.json; nothing where it is absent or null. Names are joined by slashes:
    /// "metrics/robot/position/rmse".
    std::optional<double> number(const std::string& path) const;
    std::string text(const std::string& name) const;
    /// A whole number of summary.json in digits: seeds have 64 bits, more than a double. Empty where there is
    /// none.
    std::string digits(const std::string& path) const;
    /// A list of summary.json; empty where it is absent or null.
    nlohmann::json list(const std::string& name) const;
};

/// `truth_folder`: a truth instead of the one that summary.json says the run had, "none" for no truth;
/// metrics are then those against it, or none. Where the run's own truth is gone or broken, `why_no_truth`
/// says so. Throws LogError naming file and line where a file is broken, a truth that was asked for included,
/// or no run has left `folder`.
RunFolder readRunFolder(const std::string& folder, const std::string& truth_folder = {});

}  // namespace slamot::report

#include "slamot/run/CsvSinks.h"

#include <fmt/format.h>

#include "slamot/core/particles/ParticleWeights.h"
#include "slamot/rawlog/CsvTable.h"

namespace slamot::run {
namespace {

template <class... Fields>
std::string row(const Fields&... fields) {
    std::string line;
    (appendField(line, fields), ...);
    return line;
}

std::int64_t idOf(SourceId id) {
    return id.valid() ? id.value : -1;
}

/// `t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id`
std::string landmarkRow(const Step& step, const LandmarkEstimate& l) {
    return row(step.estimate.stamp, l.id.value, l.mean.x(), l.mean.y(), l.covariance(0, 0), l.covariance(0, 1),
               l.covariance(1, 1), l.existence, l.moving, idOf(l.source));
}

}  // namespace

bool RowClock::due(const Step& step) {
    const Stamp now = step.estimate.stamp;
    if (!step.has_detections && last_ && secondsBetween(*last_, now) < interval_) return false;
    last_ = now;
    return true;
}

TrajectorySink::TrajectorySink(const std::string& folder, double interval)
    : clock_(interval), csv_(folder + "/trajectory.csv"), tum_(folder + "/trajectory.tum") {
    csv_.line("t,x,y,theta,c_xx,c_xy,c_xt,c_yy,c_yt,c_tt");
}

void TrajectorySink::step(const Step& step) {
    if (!clock_.due(step)) return;
    const auto& [pose, c] = step.estimate.robot;
    csv_.line(row(step.estimate.stamp, pose.x, pose.y, pose.theta, c(0, 0), c(0, 1), c(0, 2), c(1, 1),
                  c(1, 2), c(2, 2)));
    tum_.line(fmt::format("{} {} {} 0 0 0 {} {}", slamot::toText(step.estimate.stamp), pose.x, pose.y,
                          std::sin(0.5 * pose.theta), std::cos(0.5 * pose.theta)));
}

void TrajectorySink::end(const RunEnd&) {
    csv_.close();
    tum_.close();
}

TracksSink::TracksSink(const std::string& folder, double interval, const std::vector<std::string>& mode_names)
    : clock_(interval), csv_(folder + "/tracks.csv") {
    std::string header = "t,track,x,y,vx,vy,ax,ay";
    for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j) header += fmt::format(",c_{}_{}", i, j);
    header += ",existence";
    for (const std::string& mode : mode_names) header += ",p_" + mode;
    csv_.line(header + ",moving,source_id");
}

void TracksSink::step(const Step& step) {
    if (!clock_.due(step)) return;
    for (const TrackEstimate& track : step.estimate.tracks) {
        std::string line = row(step.estimate.stamp, track.id.value);
        for (int i = 0; i < 6; ++i) appendField(line, track.mean(i));
        for (int i = 0; i < 6; ++i)
            for (int j = i; j < 6; ++j) appendField(line, track.covariance(i, j));
        appendField(line, track.existence);
        for (const double p : track.mode_probabilities) appendField(line, p);
        appendField(line, track.moving);
        appendField(line, idOf(track.source));
        csv_.line(line);
    }
}

void TracksSink::end(const RunEnd&) {
    csv_.close();
}

void LandmarksSink::end(const RunEnd& end) {
    PartFile csv(folder_ + "/landmarks.csv");
    csv.line("id,x,y,c_xx,c_xy,c_yy,seen,first_t,last_t,existence,moving,source_id");
    for (const LandmarkEstimate& l : end.landmarks)
        csv.line(row(l.id.value, l.mean.x(), l.mean.y(), l.covariance(0, 0), l.covariance(0, 1),
                     l.covariance(1, 1), l.seen, l.first_seen, l.last_seen, l.existence, l.moving,
                     idOf(l.source)));
    csv.close();
}

LandmarksHistorySink::LandmarksHistorySink(const std::string& folder)
    : csv_(folder + "/landmarks_history.csv") {
    csv_.line("t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id");
}

void LandmarksHistorySink::step(const Step& step) {
    for (const LandmarkEstimate& l : step.touched) csv_.line(landmarkRow(step, l));
}

TentativeSink::TentativeSink(const std::string& folder, double interval)
    : clock_(interval), csv_(folder + "/tentative.csv") {
    csv_.line("t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id");
}

void TentativeSink::step(const Step& step) {
    if (clock_.due(step))
        for (const LandmarkEstimate& l : step.estimator->tentative()) csv_.line(landmarkRow(step, l));
}

ParticlesSink::ParticlesSink(const std::string& folder, double interval, int most)
    : clock_(interval), most_(most), csv_(folder + "/particles.csv") {
    csv_.line("t,particle,weight,x,y,theta");
}

void ParticlesSink::step(const Step& step) {
    if (!clock_.due(step)) return;
    const std::vector<ParticleEstimate> particles = step.estimator->particles();
    std::vector<double> weights;
    for (const ParticleEstimate& particle : particles) weights.push_back(particle.weight);
    for (const auto& [index, weight] : thinned(weights, most_)) {
        const Pose2& pose = particles[index].pose.mean;
        csv_.line(row(step.estimate.stamp, static_cast<std::int64_t>(index), weight, pose.x, pose.y, pose.theta));
    }
}

InnovationsSink::InnovationsSink(const std::string& folder) : csv_(folder + "/innovations.csv") {
    csv_.line(
        "t,sensor,kind,landmark,track,outcome,r_range,r_bearing,s_rr,s_rb,s_bb,nis,detection,"
        "log_number,log_count");
}

void InnovationsSink::step(const Step& step) {
    const RangeBearingSet& set = step.detections.rangeBearing();
    for (const Innovation& i : step.report.innovations)
        csv_.line(row(
            step.estimate.stamp, std::string_view(set.sensors[set.detections[i.detection].sensor].label),
            std::string_view(slamot::toText(i.kind)), i.landmark.value, i.track.value,
            std::string_view(slamot::toText(i.outcome)), i.residual.x(), i.residual.y(), i.covariance(0, 0),
            i.covariance(0, 1), i.covariance(1, 1), i.nis, static_cast<std::int64_t>(i.detection),
            static_cast<std::int64_t>(step.log_numbers.at(static_cast<std::size_t>(i.detection))),
            static_cast<std::int64_t>(step.log_count)));
}

StepsSink::StepsSink(const std::string& folder) : csv_(folder + "/steps.csv") {
    csv_.line("t,landmarks,tracks,ms_predict,ms_detect,ms_update");
}

void StepsSink::step(const Step& step) {
    csv_.line(row(step.estimate.stamp, step.estimate.landmark_count,
                  static_cast<std::int64_t>(step.estimate.tracks.size()), 1e3 * step.times.predict,
                  1e3 * step.times.detect, 1e3 * step.times.update));
}

}  // namespace slamot::run

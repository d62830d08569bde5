#pragma once
// Short ways to write runs and truths in tests.
#include <string>

#include "slamot/eval/RunRecord.h"
#include "slamot/rawlog/Truth.h"
#include "support/TemporaryFolder.h"

namespace slamot::eval {

inline Stamp at(double seconds) {
    return Stamp::fromSeconds(seconds);
}

inline RobotRow row(double t, double x, double y, double theta, const Matrix3& covariance = Matrix3::Zero()) {
    return {at(t), {{x, y, theta}, covariance}};
}

inline TruePose truePose(double t, double x, double y, double theta) {
    return {at(t), {x, y, theta}};
}

inline TrackEstimate track(std::int64_t id, std::int64_t source, double x, double y, double vx = 0,
                           double vy = 0) {
    TrackEstimate t;
    t.id = {id};
    t.source = {source};
    t.mean << x, y, vx, vy, 0, 0;
    t.covariance = Matrix6::Identity();
    return t;
}

inline TrueTarget trueTarget(double t, double x, double y, double vx = 0, double vy = 0) {
    return {at(t), {x, y}, {vx, vy}, {0, 0}, ""};
}

inline LandmarkEstimate landmark(std::int64_t id, std::int64_t source, double x, double y,
                                 std::int64_t seen = 1) {
    LandmarkEstimate l;
    l.id = {id};
    l.source = {source};
    l.mean = {x, y};
    l.covariance = Matrix2::Identity();
    l.seen = seen;
    return l;
}

inline InnovationRow innovation(double t, const std::string& sensor, ObjectKind kind, Outcome outcome,
                                double nis, std::int64_t track_id = -1) {
    InnovationRow r;
    r.stamp = at(t);
    r.sensor = sensor;
    r.innovation.kind = kind;
    r.innovation.outcome = outcome;
    r.innovation.nis = nis;
    r.innovation.track = {track_id};
    return r;
}

using test::TemporaryFolder;

}  // namespace slamot::eval

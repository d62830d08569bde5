#pragma once
// From log to log: between MRPT's two formats, cut in time, with chosen sensors only.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slamot/rawlog/RawlogReader.h"

namespace slamot {

struct ConvertOptions {
    /// Format written; none keeps that of the input.
    std::optional<LogFormat> format;
    /// Sensor labels to keep; empty keeps all. Odometry is always kept.
    std::vector<std::string> labels;
    /// Kept are stamps of the closed interval [from, to].
    std::optional<Stamp> from, to;
};

struct ConvertResult {
    LogFormat format = LogFormat::observations;
    /// How the input ended: what could be read of a broken log is written.
    LogEnd end = LogEnd::clean;
    std::string end_message;
    std::int64_t observations = 0;  ///< other than odometry, written
    std::int64_t odometry = 0;      ///< odometry readings or actions, written
    std::int64_t left_out = 0;      ///< outside the interval, of other labels, or of a second odometry
    /// Observations before the first or after the last odometry reading: taken to be made where that one was.
    std::int64_t without_odometry = 0;
    DropTable drops;
};

/// Reads `in`, writes `out` (see RawlogWriter). `progress` gets the part done and returns false to stop, which leaves
/// OUT.part. Throws LogError.
ConvertResult convertLog(const std::string& in, const std::string& out, const LogParameters& parameters,
                         const ConvertOptions& options, const std::function<bool(double)>& progress = {});

}  // namespace slamot

#pragma once
// A run's output folder written by hand, with numbers small enough to compute expected values from.
#include <cmath>
#include <string>

#include "support/TemporaryFolder.h"

namespace slamot::test {

/// Four steps at t = 1000, 1001, 1002, 1003; the robot at (k, 0) with an error of 0.1 k in y, sigma_y = 0.2.
inline const char* trajectory_csv =
    "t,x,y,theta,c_xx,c_xy,c_xt,c_yy,c_yt,c_tt\n"
    "1000.0000000,0,0,0,0.01,0,0,0.04,0,0.0001\n"
    "1001.0000000,1,0.1,0,0.01,0,0,0.04,0,0.0001\n"
    "1002.0000000,2,0.2,0,0.01,0,0,0.04,0,0.0001\n"
    "1003.0000000,3,0.3,0,0.01,0,0,0.04,0,0.0001\n";

inline std::string summaryJson(const std::string& log = "my.rawlog", const std::string& metrics = "null",
                               const std::string& seed = "1") {
    return R"({"program": "slamot", "version": "0.1.0", "status": "complete", "log": ")" + log +
           R"(", "truth": null, "estimator": "my_estimator", "detector": "none", "seed": )" + seed +
           R"(, "config": "[my_estimator]\nkey = 1\n[run]\nestimator = my_estimator\nseed = )" + seed +
           R"(\n", "counts": {"detections": 3, "landmarks": 1, "tracks_at_end": 0}, "drops": [{"sensor": "<b>lidar", )"
           R"("reason": "no-detector", "count": 7}], "sensors": [], "warnings": [], "estimate_sha256": "abc)" +
           seed + R"(", )"
           R"("time": {"wall_s": 1.5, "step_ms": {"mean": 0.25}}, "peak_memory_mb": 80, "metrics": )" +
           metrics + "}";
}

/// Landmarks 1 and 2, of which 2 is not in the map at the end.
inline void writeRun(const TemporaryFolder& folder, const std::string& summary = summaryJson()) {
    folder.write("trajectory.csv", trajectory_csv);
    folder.write("summary.json", summary);
    folder.write("landmarks.csv",
                 "id,x,y,c_xx,c_xy,c_yy,seen,first_t,last_t,existence,moving,source_id\n"
                 "1,5,5.5,0.04,0,0.09,3,1000.0000000,1002.0000000,1,0,10\n");
    folder.write("landmarks_history.csv",
                 "t,id,x,y,c_xx,c_xy,c_yy,existence,moving,source_id\n"
                 "1000.0000000,1,5,7,4,0,9,1,0,10\n"
                 "1001.0000000,2,9,9,1,0,1,1,0,-1\n"
                 "1002.0000000,1,5,5.5,0.04,0,0.09,1,0,10\n");
    folder.write("steps.csv",
                 "t,landmarks,tracks,ms_predict,ms_detect,ms_update\n"
                 "1000.0000000,1,0,0.5,0,1\n"
                 "1001.0000000,2,0,0.5,0,2\n"
                 "1002.0000000,1,0,0.5,0,3\n"
                 "1003.0000000,1,0,0.5,0,0\n");
    folder.write("innovations.csv",
                 "t,sensor,kind,landmark,track,outcome,r_range,r_bearing,s_rr,s_rb,s_bb,nis,detection,log_"
                 "number,log_count\n"
                 "1000.0000000,eye,landmark,1,-1,initiated,nan,nan,nan,nan,nan,nan,0,0,1\n"
                 "1001.0000000,eye,landmark,2,-1,updated,0.1,0,1,0,1,2.5,0,0,1\n"
                 "1002.0000000,eye,landmark,1,-1,rejected,0.1,0,1,0,1,20,0,0,1\n");
}

/// The robot on y = 0, landmark 10 at (5, 5).
inline void writeTruth(const TemporaryFolder& folder) {
    folder.write(
        "robot.csv",
        "t,x,y,theta\n1000.0000000,0,0,0\n1001.0000000,1,0,0\n1002.0000000,2,0,0\n1003.0000000,3,0,0\n");
    folder.write("landmarks.csv", "id,x,y\n10,5,5\n");
    folder.write("truth.json", "{}");
}

}  // namespace slamot::test

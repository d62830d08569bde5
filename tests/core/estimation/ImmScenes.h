#pragma once
// A scene for filters with modes: a robot among landmarks, and movers that turn, brake, come and go.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "slamot/core/estimation/TargetModes.h"
#include "slamot/core/random/RandomStream.h"
#include "support/Scenes.h"

namespace slamot::test {

/// Modes from the text of their config key.
inline ImmParameters immModes(const std::string& text) {
    ImmParameters imm;
    ParameterTable table("modes", "");
    describe(imm, table);
    EXPECT_FALSE(table.find("modes")->parse(text)) << text;
    return imm;
}

class ImmScene {
  public:
    struct Step {
        OdometryIncrement odometry;
        DetectionSet detections;
    };

    PoseGaussian start() const {
        return {{10, -20, 3},
                (Matrix3() << 0.02, 0.005, 0.001, 0.005, 0.01, 0.002, 0.001, 0.002, 0.003).finished()};
    }

    /// The next 0.1 s. Mover 0 is away from 2 s to 3.5 s, mover 1 comes at 1 s and goes at 4 s, mover 2 is
    /// seen about 5 s: with max_unseen of 0.75 s at most two have tracks, and three tracks end.
    Step next() {
        const int k = ++step_;
        const double t = 0.1 * k;
        const Pose2 move{0.3, 0, 0.11};
        truth_ = truth_ * move;
        Step out;
        out.odometry =
            odometry(t - 0.1, t, {move.x + 0.01 * noise(), 0.002 * noise(), move.theta + 0.01 * noise()});
        std::vector<RangeBearingDetection> seen_now;
        for (int i = 0; i < 6; ++i)
            if ((i + k) % 3 > 0)
                seen_now.push_back(seen(truth_, Vector2(10 + 6 * std::cos(i), -17 + 5 * std::sin(i)),
                                        ObjectKind::landmark, i));
        const double turn = t < 1.2 ? 0 : 2 * (t - 1.2);
        if (t < 2 || t > 3.5)
            seen_now.push_back(seen(truth_, Vector2(4 + t, -14 + std::sin(turn)), ObjectKind::mover, 0));
        if (t > 1 && t < 4)
            seen_now.push_back(seen(truth_, Vector2(15 - t * t, -22 + 0.5 * t), ObjectKind::mover, 1));
        if (t > 4.9 && t < 5.15) seen_now.push_back(seen(truth_, Vector2(12, -26 + t), ObjectKind::mover, 2));
        for (RangeBearingDetection& d : seen_now) {
            d.range += 0.1 * noise();
            d.bearing = wrapAngle(d.bearing + 0.02 * noise());
        }
        out.detections = detectionsAt(t, seen_now);
        return out;
    }

  private:
    double noise() { return random_.normal(); }

    RandomStream random_{31, RandomPurpose::test};
    Pose2 truth_{10, -20, 3};
    int step_ = 0;
};

}  // namespace slamot::test

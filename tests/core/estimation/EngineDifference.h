#pragma once
// How far two runs of the same filter on different engines are apart.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

#include "EngineTwins.h"
#include "slamot/core/data/Angle.h"

namespace slamot::test {

struct Moments {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    std::vector<Eigen::Index> kinds;  ///< dimensions of robot, movers, landmarks
};

inline Moments momentsOf(const JointView& view, const ModalRun& run) {
    const auto blocks = run.blocks();
    Moments out{Eigen::VectorXd(), view.jointCovariance(blocks), {}};
    out.mean.resize(out.covariance.rows());
    Eigen::Index row = 0;
    for (const BlockId id : blocks) {
        const BlockVector mean = view.mean(id);
        out.mean.segment(row, mean.size()) = mean;
        row += mean.size();
    }
    out.kinds = {3, static_cast<Eigen::Index>(6 * run.targets().size()),
                 static_cast<Eigen::Index>(2 * run.landmarks().size())};
    return out;
}

/// Largest differences.
struct Difference {
    /// To the largest number of its kind now: means of robot, movers, landmarks, covariances of each with
    /// each.
    double relative = 0;
    /// Of means in standard deviations, of covariances to the deviations of row and column.
    double mean_in_std = 0, covariance_in_std = 0;
    double probability = 0;

    void add(const Difference& other) {
        relative = std::max(relative, other.relative);
        mean_in_std = std::max(mean_in_std, other.mean_in_std);
        covariance_in_std = std::max(covariance_in_std, other.covariance_in_std);
        probability = std::max(probability, other.probability);
    }
};

inline double relativeTo(const Eigen::MatrixXd& difference, const Eigen::MatrixXd& expected) {
    if (difference.size() == 0) return 0;
    if (!difference.allFinite()) return std::numeric_limits<double>::infinity();
    const double off = difference.cwiseAbs().maxCoeff();
    return off == 0 ? 0 : off / expected.cwiseAbs().maxCoeff();
}

inline Difference difference(const Moments& value, const Moments& expected) {
    EXPECT_EQ(value.kinds, expected.kinds);
    Difference out;
    Eigen::VectorXd dx = value.mean - expected.mean;
    if (value.kinds.front() == 3) dx(2) = wrapAngle(dx(2));
    const Eigen::MatrixXd dP = value.covariance - expected.covariance;
    Eigen::Index row = 0;
    for (const Eigen::Index rows : value.kinds) {
        const double mean = relativeTo(dx.segment(row, rows), expected.mean.segment(row, rows));
        out.relative = std::max(out.relative, mean);
        Eigen::Index col = 0;
        for (const Eigen::Index cols : value.kinds) {
            const double covariance =
                relativeTo(dP.block(row, col, rows, cols), expected.covariance.block(row, col, rows, cols));
            out.relative = std::max(out.relative, covariance);
            col += cols;
        }
        row += rows;
    }
    // What a mode knows exactly, such as cv the acceleration, is compared as if known to 1e-6.
    const Eigen::ArrayXd std = expected.covariance.diagonal().array().max(1e-12).sqrt();
    out.mean_in_std = (dx.array() / std).abs().maxCoeff();
    out.covariance_in_std = (dP.array() / (std.matrix() * std.matrix().transpose()).array()).abs().maxCoeff();
    return out;
}

inline Difference ofRobot(const ModalRun& value, const ModalRun& expected) {
    const ModalState &a = value.belief(), &b = expected.belief();
    return difference({a.mean(robot_block), a.covariance(robot_block, robot_block), {3}},
                      {b.mean(robot_block), b.covariance(robot_block, robot_block), {3}});
}

inline Difference ofTargets(const ModalRun& value, const ModalRun& expected) {
    Difference out;
    const auto ours = value.targets(), theirs = expected.targets();
    EXPECT_EQ(ours.size(), theirs.size());
    for (std::size_t t = 0; t < ours.size(); ++t) {
        const TargetBelief a = value.belief().target(ours[t]), b = expected.belief().target(theirs[t]);
        out.add(difference({a.mean, a.covariance, {6}}, {b.mean, b.covariance, {6}}));
        out.probability =
            std::max(out.probability, (a.mode_probabilities - b.mode_probabilities).cwiseAbs().maxCoeff());
    }
    return out;
}

/// Each landmark by itself.
inline Difference ofLandmarks(const ModalRun& value, const ModalRun& expected) {
    Difference out;
    const auto ours = value.landmarks(), theirs = expected.landmarks();
    EXPECT_EQ(ours.size(), theirs.size());
    const ModalState &a = value.belief(), &b = expected.belief();
    for (std::size_t i = 0; i < ours.size(); ++i)
        out.add(difference({a.mean(ours[i]), a.covariance(ours[i], ours[i]), {2}},
                           {b.mean(theirs[i]), b.covariance(theirs[i], theirs[i]), {2}}));
    return out;
}

/// Everything with everything, merged over modes.
inline Difference ofAll(const ModalRun& value, const ModalRun& expected) {
    return difference(momentsOf(value.belief(), value), momentsOf(expected.belief(), expected));
}

/// The same in each mode.
inline Difference ofModes(const ModalRun& value, const ModalRun& expected) {
    Difference out;
    const JointBank &a = value.belief().bank(), &b = expected.belief().bank();
    EXPECT_EQ(a.modeCount(), b.modeCount());
    for (int i = 0; i < a.modeCount(); ++i)
        out.add(difference(momentsOf(a.mode(i), value), momentsOf(b.mode(i), expected)));
    return out;
}

}  // namespace slamot::test

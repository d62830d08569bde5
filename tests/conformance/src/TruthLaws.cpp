// Laws that hold the answer against the world's: symmetry, convergence, consistency.
#include <slamot/core/association/ChiSquare.h>
#include <slamot/eval/Consistency.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "conformance/Play.h"
#include "conformance/Worlds.h"
#include "conformance/src/Guarded.h"

namespace slamot::conformance {
namespace {

constexpr std::uint64_t first_seed = 100;

/// False-alarm rate of each statistical law, over all its comparisons together (Bonferroni).
constexpr double false_alarm_rate = 1e-3;

Vector3 errorOf(const Pose2& estimate, const Pose2& truth) {
    return {estimate.x - truth.x, estimate.y - truth.y, angleDifference(estimate.theta, truth.theta)};
}

/// Two-sided quantile of a normal variable, through chi-square with one degree of freedom.
double deviations(double false_alarms) {
    return std::sqrt(chiSquareQuantile(1 - false_alarms, 1));
}

/// Where a sampled estimator ends over many seeds, as errors against `reference`.
struct Spread {
    Vector3 mean = Vector3::Zero(), variance_of_mean = Vector3::Zero();
};
Spread spread(const Options& options, Play play, const Pose2& reference, std::uint64_t seed) {
    constexpr int runs = 20;
    std::vector<Vector3> errors;
    Spread out;
    const auto estimator = subjectFor(options, play);
    for (int run = 0; run < runs; ++run) {
        play.start.seed = seed + static_cast<std::uint64_t>(run);
        playAll(*estimator, play);
        errors.push_back(errorOf(estimator->robot().mean, reference));
        out.mean += errors.back() / runs;
    }
    for (const Vector3& error : errors)
        out.variance_of_mean += (error - out.mean).cwiseAbs2() / ((runs - 1.0) * runs);
    return out;
}

/// A start with a covariance that is not round, so that a wrongly turned one shows.
Play uncertainStart(std::uint64_t seed) {
    Play play = playOf(roundTrip(), seed);
    play.start.pose.covariance << 0.04, 0.01, 0.002, 0.01, 0.02, -0.001, 0.002, -0.001, 0.001;
    return play;
}

class Compared {
  public:
    explicit Compared(const Pose2& T) : T_(T), R_(rotation(T.theta)) {}

    Verdict operator()(const Estimator& moved, const Estimator& original) {
        const PoseGaussian robot = moved.robot(), reference = original.robot();
        same(errorOf(robot.mean, T_ * reference.mean), Vector3::Zero(), "the robot's pose",
             robot.mean.position().norm());
        same(robot.covariance, turned(reference.covariance, T_.theta), "the robot's covariance");
        const auto tracks = moved.tracks(), track_references = original.tracks();
        if (tracks.size() != track_references.size()) return "the number of tracks differs";
        for (std::size_t i = 0; i < tracks.size(); ++i) {
            Vector6 mean;
            Matrix6 R = Matrix6::Zero();
            for (int k = 0; k < 3; ++k) {
                R.block<2, 2>(2 * k, 2 * k) = R_;
                mean.segment<2>(2 * k) = R_ * track_references[i].mean.segment<2>(2 * k);
            }
            mean.head<2>() += T_.position();
            same(tracks[i].mean, mean, "a track's state");
            same(tracks[i].covariance, R * track_references[i].covariance * R.transpose(),
                 "a track's covariance");
        }
        const auto landmarks = moved.landmarks(), landmark_references = original.landmarks();
        if (landmarks.size() != landmark_references.size()) return "the number of landmarks differs";
        for (std::size_t i = 0; i < landmarks.size(); ++i) {
            same(landmarks[i].mean, T_ * landmark_references[i].mean, "a landmark");
            same(landmarks[i].covariance, R_ * landmark_references[i].covariance * R_.transpose(),
                 "a landmark's covariance");
        }
        return first_;
    }

  private:
    /// Coordinates of about 100 m carry rounding of 1e-14; a run amplifies it, but not by five orders.
    static constexpr double tolerance = 1e-9;

    template <class A, class B>
    void same(const A& value, const B& expected, const std::string& what, double size = 0) {
        const double scale = std::max({1.0, size, expected.cwiseAbs().maxCoeff()});
        const double off = (value - expected).cwiseAbs().maxCoeff();
        if (first_.empty() && !(off <= tolerance * scale)) first_ = fmt::format("{} is off by {}", what, off);
    }

    Pose2 T_;
    Matrix2 R_;
    Verdict first_;
};

const std::vector<Pose2> moves = {
    {100, -50, radians(30)}, {0, 0, radians(90)}, {-7, 3, pi}, {20, 80, radians(-135)}, {1000, 0, 0}};

Verdict movedExactly(const Options& options) {
    const Play play = uncertainStart(first_seed);
    const auto original = subjectFor(options, play);
    playAll(*original, play);
    for (const Pose2& T : moves) {
        const auto moved = subjectFor(options, play);
        playAll(*moved, movedBy(T, play));
        if (const Verdict verdict = Compared(T)(*moved, *original); !verdict.empty())
            return fmt::format("moved by ({}, {}) m and {} deg, {}", T.x, T.y, degrees(T.theta), verdict);
    }
    return {};
}

/// Means over disjoint sets of seeds, turned back into the original frame, differ by chance only.
Verdict movedOnAverage(const Options& options) {
    const Play play = uncertainStart(first_seed);
    const Pose2 truth = play.truth.robot.back().pose;
    const Spread original = spread(options, play, truth, 1);
    const double limit = deviations(false_alarm_rate / (3.0 * static_cast<double>(moves.size())));
    std::uint64_t seed = 1000;
    for (const Pose2& T : moves) {
        Spread moved = spread(options, movedBy(T, play), T * truth, seed += 1000);
        const Matrix2 back = rotation(-T.theta);
        moved.mean.head<2>() = back * moved.mean.head<2>();
        moved.variance_of_mean.head<2>() = back.cwiseAbs2() * moved.variance_of_mean.head<2>();
        for (int i = 0; i < 3; ++i) {
            const double off = std::abs(moved.mean(i) - original.mean(i));
            const double deviation = std::sqrt(moved.variance_of_mean(i) + original.variance_of_mean(i));
            if (!(off <= limit * deviation + 1e-9))
                return fmt::format(
                    "moved by {} deg, coordinate {} of the mean pose is off by {}, {} deviations",
                    degrees(T.theta), i, off, off / deviation);
        }
    }
    return {};
}

}  // namespace

Verdict worldMayBeMoved(const Options& options) {
    return guarded([&] {
        return options.kind == Kind::deterministic ? movedExactly(options) : movedOnAverage(options);
    });
}

Verdict bearingsAcrossPi(const Options& options) {
    return guarded([&]() -> Verdict {
        const Play play = playOf(behind(), first_seed);
        const auto estimator = subjectFor(options, play);
        Verdict first;
        int innovations = 0, odd = 0;
        playAll(*estimator, play, [&](const Estimator& now, const UpdateReport* report) {
            const double theta = now.robot().mean.theta;
            if (first.empty() && !(theta > -pi && theta <= pi))
                first = fmt::format("the heading is {}, outside (-pi, pi]", theta);
            if (!report) return;
            for (const Innovation& innovation : report->innovations) {
                if (std::isnan(innovation.nis)) continue;
                ++innovations;
                odd += innovation.outcome == Outcome::rejected || innovation.outcome == Outcome::inflated;
                // Bearings are good to 1 deg and headings to a few: half a radian is a lost turn.
                if (first.empty() && std::abs(innovation.residual.y()) > 0.5)
                    first = fmt::format("a bearing's innovation is {} rad", innovation.residual.y());
            }
        });
        if (!first.empty()) return first;
        if (odd * 20 > innovations)
            return fmt::format("{} of {} innovations counted as outliers", odd, innovations);
        // 5 m at 0.5 m/s with steering noise of 1 deg per 0.1 s: dead reckoning alone turns by
        // sqrt(100) * 0.05 m / 1 m * 1 deg = 0.5 deg, and strays by centimetres. Ten times that is a fault.
        const Vector3 error = errorOf(estimator->robot().mean, play.truth.robot.back().pose);
        if (!(error.head<2>().norm() < 1 && std::abs(error.z()) < radians(5)))
            return fmt::format("the run ends {} m and {} rad off", error.head<2>().norm(), error.z());
        return {};
    });
}

Verdict noiseFreeConverges(const Options& options) {
    return guarded([&]() -> Verdict {
        Play play = playOf(noiseFree(), first_seed);
        // The filter goes on believing in noise; with none in its model it would have nothing to weigh.
        play.motion = roundTrip().robots[0].motion;
        const Pose2 truth = play.truth.robot.back().pose;
        Vector3 error, allowance = Vector3::Zero();
        if (options.kind == Kind::deterministic) {
            const auto estimator = subjectFor(options, play);
            playAll(*estimator, play);
            error = errorOf(estimator->robot().mean, truth);
        } else {
            const Spread ends = spread(options, play, truth, 1);
            error = ends.mean;
            allowance = deviations(false_alarm_rate / 3) * ends.variance_of_mean.cwiseSqrt();
        }
        if (error.head<2>().norm() <= options.noise_free_position + allowance.head<2>().norm() &&
            std::abs(error.z()) <= options.noise_free_heading + allowance.z())
            return {};
        return fmt::format("a noise-free run ends {} m and {} rad off", error.head<2>().norm(), error.z());
    });
}

Verdict neesInBand(const Options& options) {
    return guarded([&]() -> Verdict {
        constexpr int runs = 40;
        const std::vector<std::size_t> checked_steps = {40, 80, 120, 160, 200};
        std::vector<double> sums(checked_steps.size(), 0), dimensions(checked_steps.size(), 0);
        for (int run = 0; run < runs; ++run) {
            const Play play = playOf(roughBearings(), first_seed + static_cast<std::uint64_t>(run));
            const auto estimator = subjectFor(options, play);
            estimator->start(play.start);
            std::size_t done = 0;
            for (std::size_t k = 0; k < checked_steps.size(); ++k) {
                playSteps(*estimator, play, done, checked_steps[k] + 1);
                done = checked_steps[k] + 1;
                const PoseGaussian robot = estimator->robot();
                const eval::SquaredError nees = eval::nees(
                    errorOf(robot.mean, play.truth.robot[checked_steps[k]].pose), robot.covariance);
                sums[k] += nees.value;
                dimensions[k] += nees.dimension;
            }
        }
        std::string values;
        bool inside = true;
        for (std::size_t k = 0; k < checked_steps.size(); ++k) {
            // Runs are independent, so the sum is chi-square; steps of a run are not, so each has its own
            // band.
            const double part = false_alarm_rate / static_cast<double>(checked_steps.size());
            const eval::Band band = eval::chiSquareBand(1 - part, dimensions[k], runs);
            const double mean = sums[k] / runs;
            inside = inside && band.contains(mean);
            values += fmt::format(" step {}: {:.2f} in [{:.2f}, {:.2f}];", checked_steps[k], mean, band.low,
                                  band.high);
        }
        return inside ? Verdict() : "mean NEES of the robot over 40 runs leaves its band:" + values;
    });
}

}  // namespace slamot::conformance

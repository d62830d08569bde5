// How many particles carry the belief, and how far apart they are.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "sections/Courses.h"
#include "sections/Sections.h"
#include "slamot/core/data/Angle.h"

namespace slamot::report {
namespace section_particles {

constexpr std::size_t most_windows = 150;

std::string absent(const RunFolder& run) {
    return run.particles.empty()
               ? "particles.csv is not there or empty ([output] particles, of estimators that have particles)"
               : "";
}

/// 1 / sum w^2 over different poses: copies that resampling has made, which a draw has not parted yet, are
/// one.
double effectiveNumber(const ParticleSet& set) {
    std::map<std::tuple<double, double, double>, double> weights;
    for (const auto& [number, weight, pose] : set.rows) {
        weights[{pose.x, pose.y, pose.theta}] += weight;
    }
    double squares = 0;
    for (const auto& [pose, weight] : weights) {
        squares += weight * weight;
    }
    return 1 / squares;
}

/// Standard deviations of the poses.
struct Spread {
    double position;  ///< in the direction in which it is largest [m]
    double heading;   ///< [rad]
};

Spread spreadOf(const ParticleSet& set) {
    const Pose2& origin = set.rows.front().pose;
    const auto apart = [&](const Pose2& pose) {
        return Vector3(pose.x - origin.x, pose.y - origin.y, angleDifference(pose.theta, origin.theta));
    };
    Vector3 mean = Vector3::Zero();
    for (const ParticleSet::Row& row : set.rows) {
        mean += row.weight * apart(row.pose);
    }
    Matrix3 P = Matrix3::Zero();
    for (const ParticleSet::Row& row : set.rows) {
        const Vector3 d = apart(row.pose) - mean;
        P += row.weight * d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix2> eigen(P.topLeftCorner<2, 2>());
    return {std::sqrt(std::max(0.0, eigen.eigenvalues()(1))), std::sqrt(P(2, 2))};
}

/// Particles of the filter and, where these are fewer, the most that the file has of them at a stamp.
struct Counts {
    std::int64_t all = 0;
    std::size_t kept = 0;
};

Counts countsOf(const RunFolder& run) {
    Counts counts;
    for (const ParticleSet& set : run.particles) {
        counts.kept = std::max(counts.kept, set.rows.size());
        for (const ParticleSet::Row& row : set.rows) {
            counts.all = std::max(counts.all, row.number + 1);
        }
    }
    return counts;
}

Panel numberPanel(const RunFolder& run, const Counts& counts, const std::vector<double>& numbers) {
    const Windows windows = windowsFor(run, numbers.size(), most_windows, 8);
    std::vector<std::vector<double>> values(windows.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        values[windows.of(run.particles[i].stamp)].push_back(numbers[i]);
    }
    Band range{"5 % to 95 % within a window", {}, colour::sky, 0.35};
    Line median{"median", {}, colour::blue, 1.6}, lowest{"lowest", {}, colour::grey, 0.9, Dash::dotted};
    for (std::size_t w = 0; w < windows.count(); ++w) {
        const double t = windows.middle(w);
        range.rows.push_back({t, quantile(values[w], 0.05), quantile(values[w], 0.95)});
        median.points.emplace_back(t, quantile(values[w], 0.5));
        lowest.points.emplace_back(t, quantile(values[w], 0));
    }
    Panel panel;
    panel.x = runTimeAxis(run);
    panel.y.label = "Effective number";
    panel.y.min = 0;
    panel.y.max = 1.05 * static_cast<double>(counts.kept);
    panel.height = 170;
    panel.layers = {range, median, lowest};
    return panel;
}

Panel spreadPanel(const RunFolder& run, const std::string& label, const std::string& unit,
                  const std::vector<double>& values) {
    ErrorCourse course;
    for (std::size_t i = 0; i < values.size(); ++i) {
        course.add(run.seconds(run.particles[i].stamp), values[i], 0);
    }
    breakAtGaps(course);
    Panel panel;
    panel.x = runTimeAxis(run);
    panel.y.label = label;
    panel.y.unit = unit;
    panel.y.min = 0;
    panel.height = 130;
    panel.layers = {Line{"", report::series(course.seconds, course.error), colour::blue, 1.3}};
    return panel;
}

std::vector<Block> blocks(const RunFolder& run) {
    constexpr double degrees = 180 / pi;
    std::vector<double> numbers, positions, headings;
    for (const ParticleSet& set : run.particles) {
        const Spread spread = spreadOf(set);
        numbers.push_back(effectiveNumber(set));
        positions.push_back(spread.position);
        headings.push_back(degrees * spread.heading);
    }
    const Counts counts = countsOf(run);
    Figure figure;
    figure.panels = {numberPanel(run, counts, numbers),
                     spreadPanel(run, "Spread of position", "m", positions),
                     spreadPanel(run, "Spread of heading", "°", headings)};
    std::string caption =
        fmt::format("Of {} particles the median effective number is {:.1f}, the lowest {:.1f}.", counts.all,
                    quantile(numbers, 0.5), quantile(numbers, 0));
    if (static_cast<std::int64_t>(counts.kept) < counts.all) {
        caption += fmt::format(" The file has {} of them at a stamp, chosen by weight: no more are counted.",
                               counts.kept);
    }
    return {PageFigure{"particles", "Effective number of particles and their spread over time. " + caption,
                       figure, caption}};
}

}  // namespace section_particles

const ReportSection particle_section{
    "particles", "Particles",
    "Effective number: 1 over the sum of squared weights; copies that resampling made count as one until "
    "they part. "
    "Spread: standard deviations of the particles' poses, of position in the direction where it is largest.",
    section_particles::absent, section_particles::blocks};

}  // namespace slamot::report

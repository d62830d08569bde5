// Laws about one run's state: repeatability, definiteness, order in time.
#include <slamot/core/estimation/Definiteness.h>

#include <algorithm>
#include <set>

#include "conformance/Play.h"
#include "conformance/Worlds.h"
#include "conformance/src/Guarded.h"

namespace slamot::conformance {
namespace {

constexpr std::uint64_t one_seed = 7;

/// F P F^t in floating point is symmetric to a few ulp, not to the bit.
constexpr double symmetry_tolerance = 1e-12;

Verdict definite(const Eigen::MatrixXd& P, const std::string& what) {
    if (!P.allFinite()) return what + " is not finite";
    if (P.size() == 0) return {};
    const double asymmetry = (P - P.transpose()).cwiseAbs().maxCoeff();
    if (asymmetry > symmetry_tolerance * P.cwiseAbs().maxCoeff())
        return fmt::format("{} is not symmetric: off by {}", what, asymmetry);
    if (!isPositiveSemidefinite(P, Estimator::definiteness_tolerance))
        return what + " is not positive semi-definite";
    return {};
}

Verdict definite(const Estimator& estimator) {
    Verdict verdict = definite(estimator.robot().covariance, "the robot's covariance");
    for (const TrackEstimate& track : estimator.tracks())
        if (verdict.empty())
            verdict = definite(track.covariance, fmt::format("covariance of track {}", track.id.value));
    if (verdict.empty()) verdict = definite(estimator.jointCovariance().matrix, "the joint covariance");
    return verdict.empty() ? verdict : fmt::format("{} at {}", verdict, toText(estimator.time()));
}

/// The first two moments of all particles are the robot's.
bool areMomentsOf(const PoseGaussian& robot, const std::vector<ParticleEstimate>& particles) {
    Vector3 mean = Vector3::Zero();
    Matrix3 P = Matrix3::Zero();
    for (const auto& [weight, pose] : particles) {
        Vector3 apart = pose.mean.vector() - robot.mean.vector();
        apart.z() = wrapAngle(apart.z());
        mean += weight * apart;
        P += weight * (apart * apart.transpose() + pose.covariance);
    }
    // Poses are sums over particles of numbers as large as the way; variances are differences of their squares.
    const double rounding = 1e-12 * (1 + robot.mean.position().squaredNorm());
    return mean.cwiseAbs().maxCoeff() < rounding && (P - robot.covariance).cwiseAbs().maxCoeff() < rounding;
}

Verdict agree(const Estimator& estimator) {
    const Estimate estimate = estimator.estimate();
    const auto tracks = estimator.tracks();
    const auto landmarks = estimator.landmarks();
    const JointCovariance joint = estimator.jointCovariance();
    const auto at = [&](const std::string& what) {
        return fmt::format("{} at {}", what, toText(estimator.time()));
    };

    if (estimate.stamp != estimator.time()) return at("the estimate's stamp is not the present time");
    if (estimate.landmark_count != static_cast<std::int64_t>(landmarks.size()))
        return at("landmark_count differs from the number of landmarks");
    if (estimate.tracks.size() != tracks.size()) return at("estimate() and tracks() differ in number");
    std::set<TrackId> track_ids;
    for (const TrackEstimate& track : tracks) {
        if (!track.id.valid() || !track_ids.insert(track.id).second) return at("track ids are not unique");
        if (!(track.existence >= 0 && track.existence <= 1)) return at("an existence lies outside [0, 1]");
        if (track.mode_probabilities.size() != estimator.modeNames().size())
            return at("mode probabilities and mode names differ in number");
    }
    std::set<LandmarkId> landmark_ids;
    for (const LandmarkEstimate& landmark : landmarks) {
        if (!landmark.id.valid() || !landmark_ids.insert(landmark.id).second)
            return at("landmark ids are not unique");
        const auto some = estimator.landmarks(std::vector<LandmarkId>{landmark.id});
        if (some.size() != 1 || some[0].id != landmark.id || some[0].mean != landmark.mean)
            return at("landmarks(ids) and landmarks() differ");
    }
    for (const LandmarkEstimate& candidate : estimator.tentative()) {
        if (candidate.id.valid() && !landmark_ids.insert(candidate.id).second)
            return at("a tentative landmark has the id of another");
        if (!(candidate.existence >= 0 && candidate.existence <= 1))
            return at("a tentative landmark's existence lies outside [0, 1]");
    }
    const auto particles = estimator.particles();
    if (!particles.empty() && !areMomentsOf(estimator.robot(), particles))
        return at("the particles' moments are not robot()");
    if (joint.matrix.size() == 0) return {};
    const auto size = static_cast<Eigen::Index>(3 + 6 * joint.tracks.size() + 2 * joint.landmarks.size());
    if (joint.matrix.rows() != size || joint.matrix.cols() != size)
        return at("the joint covariance has a wrong size");
    const Matrix3 robot = estimator.robot().covariance;
    const double scale = std::max(1e-300, robot.cwiseAbs().maxCoeff());
    if ((joint.matrix.topLeftCorner<3, 3>() - robot).cwiseAbs().maxCoeff() > symmetry_tolerance * scale)
        return at("the joint covariance and robot() disagree");
    return {};
}

/// Keeps the first verdict that is not empty.
template <class Check>
Verdict firstOver(Estimator& estimator, const Play& play, const Check& check) {
    Verdict first;
    playAll(estimator, play, [&](const Estimator& now, const UpdateReport* report) {
        if (first.empty()) first = check(now, report);
    });
    return first;
}

}  // namespace

Verdict sameBitsForAnyThreads(const Options& options) {
    return guarded([&]() -> Verdict {
        Play play = playOf(roundTrip(), one_seed);
        std::string first;
        for (const int threads : {1, 1, 2, 4}) {
            play.start.threads = threads;
            const std::string now = bitsOfRun(*subjectFor(options, play), play);
            if (first.empty()) first = now;
            if (now != first)
                return fmt::format("{} threads give other bits than the first run with 1", threads);
        }
        return {};
    });
}

Verdict resetEqualsNew(const Options& options) {
    return guarded([&]() -> Verdict {
        const Play play = playOf(roundTrip(), one_seed), other = playOf(roundTrip(), one_seed + 1);
        const std::string fresh = bitsOfRun(*subjectFor(options, play), play);
        const auto used = subjectFor(options, play);
        playAll(*used, other);
        if (bitsOfRun(*used, play) != fresh) return "a start after another run differs from a new object";
        used->reset();
        const std::string reset = bits(used->estimate());
        const auto started = subjectFor(options, play);
        started->start(play.start);
        if (reset != bits(started->estimate()))
            return "the estimate after reset differs from that of a new object";
        playSteps(*used, play, 0, play.steps.size());
        playAll(*started, play);
        if (bits(used->estimate()) != bits(started->estimate()))
            return "a run after reset ends otherwise than a first one";
        return {};
    });
}

Verdict covariancesStayDefinite(const Options& options) {
    return guarded([&] {
        const Play play = playOf(roughBearings(), one_seed);
        return firstOver(*subjectFor(options, play), play,
                         [](const Estimator& now, const UpdateReport*) { return definite(now); });
    });
}

Verdict emptySetIsAccepted(const Options& options) {
    return guarded([&]() -> Verdict {
        const Play play = playOf(roundTrip(), one_seed);
        const auto estimator = subjectFor(options, play);
        estimator->start(play.start);
        for (const std::size_t half : {std::size_t{0}, play.steps.size() / 2}) {
            playSteps(*estimator, play, 0, half);
            const Estimate before = estimator->estimate();
            DetectionSet empty;
            empty.stamp = estimator->time();
            const UpdateReport report = estimator->update(empty);
            const Estimate after = estimator->estimate();
            if (!report.innovations.empty()) return "an empty set has innovations";
            // Seeing nothing is news to sampled estimators: it may shift weight between samples.
            if (options.kind == Kind::sampled) continue;
            if (before.robot.mean.vector() != after.robot.mean.vector())
                return "an empty set moves the robot";
            if (before.landmark_count != after.landmark_count)
                return "an empty set changes the number of landmarks";
        }
        return {};
    });
}

Verdict timeGoingBackIsRefused(const Options& options) {
    return guarded([&]() -> Verdict {
        const Play play = playOf(roundTrip(), one_seed);
        const auto estimator = subjectFor(options, play);
        const std::size_t half = play.steps.size() / 2;
        estimator->start(play.start);
        playSteps(*estimator, play, 0, half);
        const std::string before = bits(estimator->estimate());
        const auto refused = [](const auto& action) {
            try {
                action();
            } catch (const TimeOrderError&) {
                return true;
            }
            return false;
        };

        OdometryIncrement backwards = *play.steps[half].odometry;
        std::swap(backwards.t0, backwards.t1);
        if (!refused([&] { estimator->predict(*play.steps[half - 1].odometry); }))
            return "odometry of a time gone by is taken";
        if (!refused([&] { estimator->predict(backwards); })) return "odometry that runs backwards is taken";
        if (!refused([&] { estimator->update(*play.steps[half - 2].detections); }))
            return "detections of a time gone by are taken";
        if (bits(estimator->estimate()) != before) return "a refused call has changed the estimate";
        playSteps(*estimator, play, half, play.steps.size());
        return {};
    });
}

Verdict queriesAgree(const Options& options) {
    return guarded([&] {
        const Play play = playOf(roundTrip(), one_seed);
        return firstOver(*subjectFor(options, play), play,
                         [](const Estimator& now, const UpdateReport*) { return agree(now); });
    });
}

Verdict crowdIsSurvived(const Options& options) {
    return guarded([&] {
        const Play play = withNuisances(playOf(crowd(), one_seed));
        int step = 0;
        Verdict verdict = firstOver(
            *subjectFor(options, play), play,
            [&](const Estimator& now, const UpdateReport* report) -> Verdict {
                if (!report) return {};
                const auto& set = play.steps[step].detections->rangeBearing();
                if (report->innovations.size() != set.detections.size())
                    return fmt::format("{} detections got {} innovations at {}", set.detections.size(),
                                       report->innovations.size(), toText(now.time()));
                // Whole covariances of a crowd are large: every tenth is looked at.
                return step++ % 10 == 0 ? definite(now) + agree(now) : Verdict();
            });
        return verdict;
    });
}

}  // namespace slamot::conformance

#include "MapSizeRuns.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "LaneWorld.h"
#include "Machine.h"
#include "slamot/core/estimation/CompressedJointBank.h"
#include "slamot/core/filter/JointFilter.h"
#include "slamot/core/plugin/PluginRegistry.h"

namespace slamot::bench {
namespace {

const Matrix3 start_covariance = 1e-6 * Matrix3::Identity();

JointFilterParameters parametersFor(JointEngine::Kind engine) {
    JointFilterParameters parameters;
    parameters.consistency = Consistency::invariant;
    parameters.engine.kind = engine;
    return parameters;
}

/// Modes as imm_slamot has them by default; the third turns at 20 deg/s.
std::vector<TargetMode> firstModes(int count) {
    TargetMode cv{"cv", {}}, ca{"ca", {}}, ct{"ct", {}};
    cv.model = {TargetModelKind::cv, 0.5};
    ca.model = {TargetModelKind::ca, 1.5};
    ct.model = {TargetModelKind::ct, 0.5};
    ct.model.turn_rate = radians(20.0);
    std::vector<TargetMode> modes{cv, ca, ct};
    modes.resize(static_cast<std::size_t>(count));
    return modes;
}

const CompressedJointBank& compressedBank(const JointFilter& filter) {
    return dynamic_cast<const CompressedJointBank&>(filter.state());
}

double errorOf(const Pose2& estimate, const Pose2& truth) {
    return (estimate.position() - truth.position()).norm();
}

std::size_t countSeen(const DetectionSet& seen) {
    return seen.rangeBearing().detections.size();
}

/// Counts a bank's events from step to step.
class EventCounter {
  public:
    StepEvents next(const CompressedJointBank& bank) {
        const StepEvents events{bank.commits() != commits_, bank.activations() != activations_,
                                bank.unforeseen() != unforeseen_};
        commits_ = bank.commits();
        activations_ = bank.activations();
        unforeseen_ = bank.unforeseen();
        return events;
    }

  private:
    std::int64_t commits_ = 0, activations_ = 0, unforeseen_ = 0;
};

/// Waits until the next step is to come. Steps that are late do not move those after them.
class Metronome {
  public:
    explicit Metronome(double rate) : period_(rate > 0 ? 1 / rate : 0) {}
    void wait() {
        if (period_ == std::chrono::duration<double>(0)) return;
        const auto after =
            std::chrono::duration_cast<std::chrono::steady_clock::duration>(++steps_ * period_);
        std::this_thread::sleep_until(begin_ + after);
    }

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::chrono::duration<double> period_;
    std::int64_t steps_ = 0;
};

/// Drives a filter from a full map on until patience ends. The first step is not counted: it sets sizes.
template <class Filter, class Look>
FilledRun driveOn(Filter& filter, LaneWorld& world, std::size_t from, const Patience& patience,
                  const Look& look) {
    FilledRun run;
    const double begin = timeNow().wall;
    const auto patient = [&] {
        return run.times.size() < 3 || timeNow().wall - begin < 1e3 * patience.seconds;
    };
    std::size_t k = from + 1;
    for (; run.times.size() < patience.steps && patient() && k < world.path().size(); ++k) {
        const OdometryIncrement odometry = world.odometry(k);
        const DetectionSet seen = look(k);
        const StepTime time = timeStep(filter, odometry, seen);
        if (k == from + 1) continue;
        run.times.push_back(time);
        run.seen += static_cast<double>(countSeen(seen));
    }
    run.seen /= static_cast<double>(run.times.size());
    run.end_error = errorOf(filter.robot().mean, world.path()[k - 1]);
    return run;
}

}  // namespace

std::size_t covarianceBytes(int landmarks) {
    const std::size_t dimension = 3 + 2 * static_cast<std::size_t>(landmarks);
    return sizeof(double) * dimension * dimension;
}

CompressedRun runCompressed(WorldLayout layout, int landmarks, double step, const Pace& pace) {
    LaneWorld world(layout, landmarks, step);
    CompressedRun run;
    run.layout = layout;
    run.pace = pace;
    run.steps.reserve(world.path().size());
    const ResidentGrowth resident;
    JointFilterParameters parameters = parametersFor(JointEngine::Kind::compressed);
    parameters.engine.background = pace.background;
    JointFilter filter(parameters, {});
    filter.start(world.stamp(0), {world.path().front(), start_covariance});
    EventCounter counter;
    Metronome metronome(pace.rate);
    const auto on_other_threads = [] { return processTime() - timeNow().processor; };
    const double at_start = on_other_threads();
    double half_way = at_start;
    for (std::size_t k = 1; k < world.path().size(); ++k) {
        const OdometryIncrement odometry = world.odometry(k);
        const DetectionSet seen = world.look(k);
        metronome.wait();
        const StepTime time = timeStep(filter, odometry, seen);
        if (!world.secondPass(k)) half_way = on_other_threads();
        const CompressedJointBank& bank = compressedBank(filter);
        run.steps.push_back({time, counter.next(bank), world.secondPass(k)});
        run.seen += static_cast<double>(countSeen(seen));
        // Asking waits for the thread: seldom, so that it has to keep up by itself.
        if (k % 1000 == 0 || k + 1 == world.path().size())
            run.memory.state = std::max(run.memory.state, bank.memory());
    }
    const auto steps = static_cast<double>(run.steps.size());
    run.background_first = (half_way - at_start) / (0.5 * steps);
    run.background_second = (on_other_threads() - half_way) / (0.5 * steps);
    run.seen /= steps;
    run.landmarks = static_cast<int>(filter.landmarkCount());
    run.memory.resident = resident.peak();
    run.end_error = errorOf(filter.robot().mean, world.path().back());
    return run;
}

FilledRun runDense(int landmarks, double step, const Patience& patience) {
    LaneWorld world(WorldLayout::field, landmarks, step);
    const std::size_t from = world.middle();
    JointFilter filter(parametersFor(JointEngine::Kind::dense), {});
    filter.start(world.stamp(from), {world.path()[from], start_covariance});
    filter.update(world.lookAtAll(from));
    return driveOn(filter, world, from, patience, [&](std::size_t k) { return world.look(k); });
}

std::size_t denseBytes(int landmarks) {
    return 5 * covarianceBytes(landmarks);
}

FilledRun runKfSlam(int landmarks, double step, const Patience& patience) {
    LaneWorld world(WorldLayout::field, landmarks, step);
    const std::size_t from = world.middle();
    const auto estimator = PluginRegistry::discover().createEstimator("mrpt_kf_slam");
    estimator->initialize({});
    Start start;
    start.stamp = world.stamp(from);
    start.pose = {world.path()[from], start_covariance};
    estimator->start(start);
    estimator->update(world.lookAtAll(from));
    return driveOn(*estimator, world, from, patience, [&](std::size_t k) { return world.look(k); });
}

MemoryUse runModes(int landmarks, int modes) {
    LaneWorld world(WorldLayout::field, landmarks, 1.0);
    JointFilterParameters parameters = parametersFor(JointEngine::Kind::compressed);
    parameters.imm.modes = firstModes(modes);
    parameters.imm.form = ImmForm::exact;
    MemoryUse memory;
    const ResidentGrowth resident;
    JointFilter filter(parameters, {});
    filter.start(world.stamp(0), {world.path().front(), start_covariance});
    EventCounter counter;
    for (std::size_t k = 1; !world.secondPass(k); ++k) {
        DetectionSet seen = world.look(k);
        world.addMovers(1, k, seen);
        filter.predict(world.odometry(k));
        filter.update(seen);
        const CompressedJointBank& bank = compressedBank(filter);
        if (counter.next(bank).any() || world.secondPass(k + 1))
            memory.state = std::max(memory.state, bank.memory());
    }
    memory.resident = resident.peak();
    return memory;
}

MoversRun runMovers(JointEngine::Kind engine, int movers, int landmarks, double step,
                    const Patience& patience) {
    LaneWorld world(WorldLayout::field, landmarks, step);
    JointFilterParameters parameters = parametersFor(engine);
    parameters.imm.modes = firstModes(2);
    parameters.imm.form = ImmForm::scalable;
    JointFilter filter(parameters, {});
    const auto look = [&](std::size_t k) {
        DetectionSet seen = world.look(k);
        world.addMovers(movers, k, seen);
        return seen;
    };
    MoversRun run;
    if (engine == JointEngine::Kind::dense) {
        const std::size_t from = world.middle();
        filter.start(world.stamp(from), {world.path()[from], start_covariance});
        DetectionSet all = world.lookAtAll(from);
        world.addMovers(movers, from, all);
        filter.update(all);
        run.times = driveOn(filter, world, from, patience, look).times;
    } else {
        filter.start(world.stamp(0), {world.path().front(), start_covariance});
        for (std::size_t k = 1; k < world.path().size(); ++k) {
            const OdometryIncrement odometry = world.odometry(k);
            const StepTime time = timeStep(filter, odometry, look(k));
            if (world.secondPass(k)) run.times.push_back(time);
        }
    }
    run.dimension = filter.state().dimension();
    return run;
}

}  // namespace slamot::bench

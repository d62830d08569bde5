#pragma once
// The runs behind map_size_bench: the step time and the memory of one filter over one map, a field where no
// layout is given.
#include <cstddef>
#include <string>
#include <vector>

#include "StepTimes.h"
#include "WorldLayout.h"
#include "slamot/core/estimation/JointEngine.h"

namespace slamot::bench {

/// What happened in a step of the compressed engine; several things may.
struct StepEvents {
    bool commit = false, activation = false;
    bool unforeseen = false;  ///< an activation of what was seen before it had been prepared
    bool any() const { return commit || activation; }
};

struct CompressedStep {
    StepTime time;
    StepEvents events;
    bool second_pass = false;
};

/// Bytes.
struct MemoryUse {
    std::size_t state = 0;     ///< the bank's own count at its largest
    std::size_t resident = 0;  ///< growth of the process's resident memory at its peak
};

/// One full covariance over the robot and so many landmarks.
std::size_t covarianceBytes(int landmarks);

/// How steps come, and whether the engine has a thread for what is put away.
struct Pace {
    double rate = 0;  ///< [Hz], by the clock on the wall; 0: each as soon as the one before is done
    bool background = false;
};

struct CompressedRun {
    WorldLayout layout = WorldLayout::field;
    Pace pace;
    int landmarks = 0;  ///< in the map at the end
    double seen = 0;    ///< landmarks a step, mean
    std::vector<CompressedStep> steps;
    MemoryUse memory;
    double end_error = 0;                                ///< [m], of the robot's position
    double background_first = 0, background_second = 0;  ///< [ms] a step of each pass, on other threads
};
/// ekf_slamot, invariant, over a run that sees all of the map twice.
CompressedRun runCompressed(WorldLayout layout, int landmarks, double step, const Pace& pace = {});

/// Steps in the midst of a map that is all there.
struct FilledRun {
    double seen = 0;  ///< landmarks a step, mean
    std::vector<StepTime> times;
    double end_error = 0;  ///< [m], of the robot's position
};
/// When such a run ends: not before three steps.
struct Patience {
    std::size_t steps = 40;
    double seconds = 60;
};
/// ekf_slamot, invariant, dense engine.
FilledRun runDense(int landmarks, double step, const Patience& patience);
/// Bytes that a dense run may need for moments: storage grows by doubling, and the old one is there until the
/// new one is filled.
std::size_t denseBytes(int landmarks);
/// MRPT's EKF-SLAM through its plugin.
FilledRun runKfSlam(int landmarks, double step, const Patience& patience);

/// imm_slamot's exact form with the compressed engine and one mover in sight, over a run with steps of 1 m
/// that sees all of the map once. 1 mode: cv; 2: and ca; 3: and ct.
MemoryUse runModes(int landmarks, int modes);

struct MoversRun {
    int dimension = 0;  ///< of the joint state at the end
    std::vector<StepTime> times;
};
/// imm_slamot's scalable form with modes cv and ca, all movers in sight in every step. Compressed: a run that
/// sees all of the map twice, its second pass. Dense: as runDense.
MoversRun runMovers(JointEngine::Kind engine, int movers, int landmarks, double step,
                    const Patience& patience);

}  // namespace slamot::bench

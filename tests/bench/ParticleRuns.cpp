#include "ParticleRuns.h"

#include <fmt/format.h>

#include <cmath>

#include "LaneWorld.h"
#include "Machine.h"
#include "conformance/Play.h"
#include "slamot/core/particles/LandmarkFilters.h"
#include "slamot/core/particles/ParticleFilter.h"
#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/sim/Scenario.h"

namespace slamot::bench {
namespace {

const sim::Scenario& world() {
    static const sim::Scenario scenario =
        sim::loadScenario(Config::fromFile(SLAMOT_SOURCE_DIR "/config/scenarios/rfs_world.ini"));
    return scenario;
}

void hideIdentities(DetectionSet& set) {
    for (RangeBearingDetection& detection : std::get<RangeBearingSet>(set.measurements).detections)
        detection.source = {};
}

}  // namespace

int worldLandmarks() {
    return world().world.landmarks;
}

WorldRun runWorld(const Contender& contender, std::uint64_t seed) {
    conformance::Play play = conformance::playOf(world(), seed);
    conformance::Options options;
    options.plugin = contender.plugin;
    options.config = contender.config;
    const auto estimator = conformance::createSubject(options);
    estimator->initialize(conformance::configFor(options, play));
    estimator->start(play.start);

    WorldRun run;
    double squares = 0;
    for (conformance::PlayStep& step : play.steps) {
        if (step.detections && !contender.known) hideIdentities(*step.detections);
        if (step.odometry && step.detections)
            run.times.push_back(timeStep(*estimator, *step.odometry, *step.detections));
        else if (step.odometry)
            estimator->predict(*step.odometry);
        else if (step.detections)
            estimator->update(*step.detections);
        const auto truth = play.truth.pointAt(estimator->time());
        squares += (estimator->robot().mean.position() - truth->position()).squaredNorm();
    }
    run.rmse = std::sqrt(squares / static_cast<double>(play.steps.size()));
    run.final_landmarks = static_cast<double>(estimator->estimate().landmark_count);
    return run;
}

ScaleRun runScale(int particles, int landmarks) {
    LaneWorld lanes(WorldLayout::field, landmarks, 1.0);
    ParticleParameters p;
    p.count = particles;
    LandmarkFilterParameters map;
    map.association = ParticleAssociation::known;
    ScaleRun run{particles, landmarks, {}, 0, 0, 0};
    const ResidentGrowth resident;
    ParticleFilter<LandmarkFilters> filter(p, {}, LandmarkFilters::Settings(map, p.transform),
                                           ScanMaker(map.life, false), 1);
    filter.start({lanes.path().front(), 1e-6 * Matrix3::Identity()}, 1);
    for (std::size_t k = 1; k < lanes.path().size(); ++k) {
        const OdometryIncrement odometry = lanes.odometry(k);
        const DetectionSet seen = lanes.look(k);
        const StepTime time = timeStep(filter, odometry, seen);
        if (!lanes.secondPass(k)) continue;
        run.times.push_back(time);
        run.seen += static_cast<double>(seen.rangeBearing().detections.size());
    }
    run.seen /= static_cast<double>(run.times.size());
    run.resident = resident.peak();
    run.end_error = (filter.robot().mean.position() - lanes.path().back().position()).norm();
    return run;
}

}  // namespace slamot::bench

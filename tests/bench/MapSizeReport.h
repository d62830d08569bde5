#pragma once
// What map_size_bench has measured, as tables and as a figure.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "MapSizeRuns.h"
#include "slamot/report/Figure.h"
#include "slamot/study/Tables.h"

namespace slamot::bench {

struct SizeResult {
    CompressedRun compressed;
    std::optional<FilledRun> dense, kf_slam;
};
struct ModesResult {
    int landmarks, modes;
    MemoryUse memory;
};
struct MoversResult {
    std::string engine;
    int movers, landmarks;
    MoversRun run;
};
struct Results {
    std::vector<SizeResult> sizes;     ///< over the field, by rising size
    std::vector<CompressedRun> roads;  ///< by rising size
    std::vector<CompressedRun> paced;  ///< at a sensor's rate, with a thread for what is put away
    std::vector<ModesResult> modes;
    std::vector<MoversResult> movers;
};

/// Of the steps of a run that are wanted.
TimeSummary summarise(const CompressedRun& run, const std::function<bool(const CompressedStep&)>& wanted);

/// Compressed runs over the field, then over the road.
std::vector<const CompressedRun*> compressedRuns(const Results& results);

/// Engines and kf-slam by map size, over the field: the second pass of the compressed engine, so that all
/// have the full map.
study::Table timesTable(const Results& results);
/// The compressed engine by world, map size and pass.
study::Table passesTable(const Results& results);
/// Each kind of step of the compressed engine on the largest map of each world.
study::Table stepsTable(const Results& results);
/// Each kind of step at a sensor's rate.
study::Table pacedTable(const Results& results);
/// Over the field.
study::Table memoryTable(const Results& results);
study::Table moversTable(const Results& results);
/// All step times there are, for map_size.csv.
study::Table allTimesTable(const Results& results);

/// Time of a step and memory against the size of the map, over the field.
report::Figure mapSizeFigure(const Results& results);

}  // namespace slamot::bench

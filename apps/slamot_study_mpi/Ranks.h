#pragma once
// A study over MPI ranks: rank 0 owns the store and hands out units one by one, so that fast ranks take more;
// the others run them and send the rows back.
#include <atomic>
#include <boost/mpi/communicator.hpp>
#include <functional>

#include "slamot/core/plugin/PluginRegistry.h"
#include "slamot/study/Runner.h"

namespace slamot::study {

/// Rank 0, with at least one other: returns when all units are done or, once stopped, all that were under
/// way. A rank that was stopped gets no more, and what it left goes to the others; rows are missing when all were.
StudyTimes handOut(const boost::mpi::communicator& world, const Plan& plan, const std::vector<Unit>& units,
                   const std::atomic<bool>& stop, const std::function<void(const StudyProgress&)>& progress,
                   const std::function<void(const Row&)>& take);

/// The other ranks.
void work(const boost::mpi::communicator& world, const Plan& plan, const PluginRegistry& registry,
          const std::atomic<bool>& stop);

/// Throws ConfigError on ranks whose plan is not rank 0's: other files, another program, other plugins.
void requireSamePlan(const boost::mpi::communicator& world, const Plan& plan);

}  // namespace slamot::study

#pragma once

namespace slamot::run {

/// CPU time [s] of the calling thread.
double threadCpuSeconds();
/// CPU time [s] of all threads of the process.
double processCpuSeconds();

}  // namespace slamot::run

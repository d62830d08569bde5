#include "slamot/study/Row.h"
namespace slamot::study {
double figureOf(const Row& row, const std::string& name) {
    const Cost& c = row.cost;
    static const std::map<std::string, double Cost::*> costs = {
        {"cost.wall_s", &Cost::wall_s}, {"cost.simulate_s", &Cost::simulate_s},
        {"cost.step_ms_mean", &Cost::step_ms_mean}, {"cost.step_ms_p50", &Cost::step_ms_p50},
        {"cost.step_ms_p99", &Cost::step_ms_p99}, {"cost.step_ms_max", &Cost::step_ms_max},
        {"cost.memory_mb", &Cost::memory_mb}};
    if (const auto f = costs.find(name); f != costs.end()) return c.*f->second;
    const auto found = row.metrics.find(name);
    return found == row.metrics.end() ? Cost::none : found->second;
}
}  // namespace slamot::study

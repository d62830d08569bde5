#include "slamot/study/Row.h"

#include "CostFields.h"
#include "RowJson.h"

namespace slamot::study {

double figureOf(const Row& row, const std::string& name) {
    const std::string cost_prefix = "cost.";
    if (name.rfind(cost_prefix, 0) == 0) {
        for (const auto& [field_name, field] : cost_fields)
            if (name.substr(cost_prefix.size()) == field_name) return row.cost.*field;
        return Cost::none;
    }
    const auto found = row.metrics.find(name);
    return found == row.metrics.end() ? Cost::none : found->second;
}

void setLabels(Row& row, const Plan& plan, const WorldPlan& world, const RunPlan& run) {
    const bool simulated = plan.kinds[world.kind].scenario.has_value();
    row.source = plan.sourceOf(world).name;
    row.variant = plan.variantOf(run).name;
    row.scenario_point = simulated ? plan.study.scenario_grid[world.scenario_point] : GridPoint();
    row.config_point = plan.study.config_grid[run.config_point];
    row.replicate = world.replicate;
}

std::string identity(const Row& row) {
    nlohmann::json json = toJson(row);
    json.erase("cost");
    json.erase("build");
    return dumped(json);
}

nlohmann::json toJson(const Row& row) {
    return {{"key", row.key},
            {"source", row.source},
            {"variant", row.variant},
            {"scenario_point", pointJson(row.scenario_point)},
            {"config_point", pointJson(row.config_point)},
            {"replicate", row.replicate},
            {"world_seed", row.world_seed},
            {"estimator_seed", row.estimator_seed},
            {"status", row.status},
            {"reason", row.reason},
            {"estimate_hash", row.estimate_hash},
            {"metrics", metricsJson(row.metrics)},
            {"series", seriesJson(row.series)},
            {"cost", costJson(row.cost)},
            {"build", row.build}};
}

Row rowFromJson(const nlohmann::json& json) {
    Row row;
    json.at("key").get_to(row.key);
    json.at("source").get_to(row.source);
    json.at("variant").get_to(row.variant);
    row.scenario_point = pointFrom(json.at("scenario_point"));
    row.config_point = pointFrom(json.at("config_point"));
    json.at("replicate").get_to(row.replicate);
    json.at("world_seed").get_to(row.world_seed);
    json.at("estimator_seed").get_to(row.estimator_seed);
    json.at("status").get_to(row.status);
    json.at("reason").get_to(row.reason);
    json.at("estimate_hash").get_to(row.estimate_hash);
    row.metrics = metricsFrom(json.at("metrics"));
    row.series = seriesFrom(json.at("series"));
    row.cost = costFrom(json.at("cost"));
    json.at("build").get_to(row.build);
    return row;
}

}  // namespace slamot::study

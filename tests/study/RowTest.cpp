#include <cmath>
#include <nlohmann/json.hpp>

#include "StudyFolder.h"
#include "slamot/study/Row.h"

namespace slamot::study {
namespace row_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

Row sample() {
    Row row;
    row.key = "k";
    row.source = "paper1";
    row.variant = "classic";
    row.scenario_point = {{"sensor.landmarks.range_std", "0.1"}};
    row.config_point = {{"b.z", "1"}, {"a.y", "2"}};
    row.replicate = 7;
    row.world_seed = 18446744073709551615ull;
    row.estimator_seed = 9007199254740993ull;  // 2^53 + 1, which is no double
    row.status = "failed";
    row.reason = "a sentence with \xe9, which is no UTF-8";
    row.estimate_hash = "h";
    row.metrics = {{"third", 1.0 / 3}, {"tiny", 5e-324}, {"minus_zero", -0.0}, {"float", 0.5}};
    row.series["robot_nees"] = {{0, 0.1}, {std::nan(""), infinity}, {3, 2}};
    row.cost.wall_s = 0.1;
    row.cost.host = "here";
    row.build = "b";
    return row;
}

TEST(Row, ComesBackBitForBitAsBytes) {
    const Row row = sample();
    const Row again = rowFromJson(nlohmann::json::from_cbor(nlohmann::json::to_cbor(toJson(row))));
    EXPECT_EQ(again.world_seed, row.world_seed);
    EXPECT_EQ(again.estimator_seed, row.estimator_seed);
    EXPECT_EQ(again.reason, row.reason);
    EXPECT_EQ(again.config_point, row.config_point);
    EXPECT_EQ(again.metrics, row.metrics);
    EXPECT_TRUE(std::signbit(again.metrics.at("minus_zero")));
    const Series& series = again.series.at("robot_nees");
    EXPECT_EQ(series.seconds, row.series.at("robot_nees").seconds);
    EXPECT_TRUE(std::isnan(series.value[0]));
    EXPECT_EQ(series.value[1], infinity);
    EXPECT_EQ(series.dimension, row.series.at("robot_nees").dimension);
    EXPECT_EQ(again.cost.wall_s, 0.1);
    EXPECT_TRUE(std::isnan(again.cost.memory_mb));
    EXPECT_EQ(again.build, "b");
    EXPECT_EQ(identity(again), identity(row));
}

TEST(Row, IdentityIsAllButCostAndBuild) {
    const Row row = sample();
    Row other = row;
    other.cost.wall_s = 5;
    other.cost.host = "there";
    other.build = "another";
    EXPECT_EQ(identity(other), identity(row));
    const auto differs = [&](const auto& change) {
        Row changed = row;
        change(changed);
        return identity(changed) != identity(row);
    };
    EXPECT_TRUE(differs([](Row& r) { r.metrics["third"] = std::nextafter(1.0 / 3, 1.0); }));
    EXPECT_TRUE(differs([](Row& r) { r.metrics["minus_zero"] = 0.0; }));
    EXPECT_TRUE(differs([](Row& r) { r.series["robot_nees"].value[0] = infinity; }));
    EXPECT_TRUE(differs([](Row& r) { r.series["robot_nees"].dimension[1] = 3; }));
    EXPECT_TRUE(differs([](Row& r) { r.reason += "."; }));
    EXPECT_TRUE(differs([](Row& r) { r.status = "complete"; }));
    EXPECT_TRUE(differs([](Row& r) { r.config_point = {{"a.y", "2"}, {"b.z", "1"}}; }));
    EXPECT_TRUE(differs([](Row& r) { --r.estimator_seed; }));
}

TEST(Row, FiguresAreMetricsOrCosts) {
    const Row row = sample();
    EXPECT_EQ(figureOf(row, "float"), 0.5);
    EXPECT_EQ(figureOf(row, "cost.wall_s"), 0.1);
    EXPECT_TRUE(std::isnan(figureOf(row, "cost.host")));
    EXPECT_TRUE(std::isnan(figureOf(row, "nothing")));
}

}  // namespace row_test
}  // namespace slamot::study

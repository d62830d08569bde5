#include <future>

#include "StudyFolder.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/study/Store.h"
#include "support/Expect.h"

namespace slamot::study {
namespace store_test {

using test::messageOf;
using testing::HasSubstr;

class StoreTest : public StudyFolder {
  protected:
    const Plan laid = plan(usual("2"));
    const std::vector<Row> computed = run(laid);

    Store open(const std::string& name) const { return Store(folder.path(name), laid.study); }
    void fill(const std::string& name, std::size_t begin, std::size_t end) const {
        Store store(folder.path(name), laid.study);
        for (std::size_t i = begin; i < end; ++i) store.add(computed[i]);
    }
};

TEST_F(StoreTest, GivesTheRowsBackInThePlansOrderAndBitForBit) {
    {
        Store store(folder.path("a.db"), laid.study);
        for (auto row = computed.rbegin(); row != computed.rend(); ++row) store.add(*row);
    }
    const Store store(folder.path("a.db"), laid.study);
    const std::vector<Row> rows = store.rows(laid);
    std::vector<std::string> order;
    for (const Row& row : rows)
        order.push_back(row.source + " " + row.variant + " " + std::to_string(row.replicate));
    EXPECT_THAT(order, testing::ElementsAre("near classic 1", "near classic 2", "near invariant 1",
                                            "near invariant 2", "far classic 1", "far classic 2",
                                            "far invariant 1", "far invariant 2"));
    EXPECT_EQ(identities(rows), identities(computed));
    EXPECT_EQ(keysOf(laid, store.done(laid)), keysOf(laid));
    EXPECT_EQ(rows[0].build, laid.configs[0].build);
}

TEST_F(StoreTest, ReplacesFailedRowsAndRefusesOthersThatDiffer) {
    Store store(folder.path("a.db"), laid.study);
    Row failed = computed[0];
    failed.status = "failed", failed.reason = "no luck";
    store.add(failed);
    EXPECT_EQ(store.done(laid).size(), 1u);
    EXPECT_EQ(store.done(laid, true).size(), 0u);
    store.add(computed[0]);
    EXPECT_EQ(store.count(), 1u);
    EXPECT_EQ(identities(store.rows(laid)), identities({computed[0]}));
    EXPECT_EQ(store.done(laid, true).size(), 1u);

    Row again = computed[0];
    again.cost.wall_s += 1, again.build = "another";
    store.add(again);  // the same but for what is no part of its identity
    EXPECT_NE(store.rows(laid).at(0).build, "another");
    EXPECT_THAT(messageOf<LogError>([&] { store.add(failed); }),
                HasSubstr("differs from the one computed now"));
    again.metrics["robot.position.rmse"] = std::nextafter(again.metrics.at("robot.position.rmse"), 1e9);
    EXPECT_THAT(messageOf<LogError>([&] { store.add(again); }), HasSubstr("a.db"));
    EXPECT_EQ(identities(store.rows(laid)), identities({computed[0]}));
}

TEST_F(StoreTest, RowsAreNamedByThePlanThatAsks) {
    fill("a.db", 0, 8);
    // The grid is put around the value that was there: the same runs.
    std::string text = usual("2");
    const std::string value = "ekf_slamot.consistency = classic\n";
    const Plan grown = plan(text.replace(text.find(value), value.size(), "") +
                            "[grid]\nekf_slamot.consistency = classic | invariant\n");
    const Store store(folder.path("a.db"), grown.study);
    const std::vector<Row> rows = store.rows(grown);
    std::set<std::string> points;
    for (const Row& row : rows) {
        ASSERT_EQ(row.config_point.size(), 1u) << row.variant;
        points.insert(row.variant + " " + row.config_point[0].second);
    }
    EXPECT_THAT(points, testing::ElementsAre("classic classic", "invariant invariant"));
}

TEST_F(StoreTest, SimultaneousProgramsMakeOneFile) {
    for (int round = 0; round < 20; ++round) {
        const std::string file = folder.path("new" + std::to_string(round) + ".db");
        std::vector<std::future<std::size_t>> opened;
        for (int program = 0; program < 8; ++program)
            opened.push_back(std::async(std::launch::async, [&, program] {
                Store store(file, laid.study);
                store.add(computed[static_cast<std::size_t>(program)]);
                return store.count();
            }));
        for (auto& one : opened) EXPECT_GE(one.get(), 1u);
        EXPECT_EQ(Store(file, laid.study).count(), 8u);
    }
}

TEST_F(StoreTest, RowsOfAnEarlierFormOfTheStudyAreLeftOut) {
    fill("a.db", 0, 8);
    std::string text = usual("2");
    const Plan changed = plan(text.replace(text.find("max_range = 15"), 14, "max_range = 16"));
    const Store store(folder.path("a.db"), changed.study);
    EXPECT_EQ(store.count(), 8u);
    EXPECT_EQ(store.rows(changed).size(), 4u);
    EXPECT_EQ(store.done(changed).size(), 4u);
}

TEST_F(StoreTest, RowsOfAnotherBuildAreRefusedUnlessAskedFor) {
    {
        Store store(folder.path("a.db"), laid.study);
        Row row = computed[0];
        row.build = "another";
        store.add(row);
        store.add(computed[1]);
    }
    const Store store(folder.path("a.db"), laid.study);
    EXPECT_THAT(messageOf<LogError>([&] { store.requireBuild(laid); }), HasSubstr("1 of its 2 rows"));
    EXPECT_EQ(store.done(laid).size(), 2u);

    Store all(folder.path("all.db"), laid.study);
    EXPECT_THAT(messageOf<LogError>([&] { all.merge(folder.path("a.db"), laid, false); }),
                HasSubstr("a.db: 1 of its 2 rows"));
    EXPECT_EQ(all.count(), 0u);
    all.merge(folder.path("a.db"), laid, true);
    EXPECT_EQ(all.count(), 2u);
}

TEST_F(StoreTest, MergesAndRefusesContradictions) {
    fill("a.db", 0, 5);
    fill("b.db", 3, 8);
    {
        Store store(folder.path("all.db"), laid.study);
        for (const char* name : {"a.db", "b.db", "a.db"}) store.merge(folder.path(name), laid, false);
        EXPECT_EQ(identities(store.rows(laid)), identities(computed));
    }
    {
        Store store(folder.path("c.db"), laid.study);
        Row row = computed[2];
        row.metrics["robot.position.rmse"] = std::nextafter(row.metrics.at("robot.position.rmse"), 1e9);
        store.add(row);
        store.add(computed[7]);
    }
    Store store(folder.path("all.db"), laid.study);
    const std::string told = messageOf<LogError>([&] { store.merge(folder.path("c.db"), laid, false); });
    EXPECT_THAT(told, HasSubstr("c.db"));
    EXPECT_THAT(told, HasSubstr(computed[2].variant + " on " + computed[2].source));
    EXPECT_THAT(messageOf<LogError>([&] { store.merge(folder.path("gone.db"), laid, false); }),
                HasSubstr("gone.db: is not there"));
    // A refused file gives no row at all and does not stand in the way of the next.
    Store fresh(folder.path("fresh.db"), laid.study);
    fresh.add(computed[2]);
    EXPECT_NE(messageOf<LogError>([&] { fresh.merge(folder.path("c.db"), laid, false); }), "");
    EXPECT_EQ(fresh.count(), 1u);
    fresh.merge(folder.path("b.db"), laid, false);
    EXPECT_EQ(fresh.count(), 6u);
}

TEST_F(StoreTest, MergingPrefersWhatDidNotFail) {
    fill("good.db", 0, 1);
    Row failed = computed[0];
    failed.status = "failed";
    {
        Store store(folder.path("failed.db"), laid.study);
        store.add(failed);
    }
    for (const auto& order : {std::pair("good.db", "failed.db"), std::pair("failed.db", "good.db")}) {
        Store store(folder.path(std::string("from_") + order.first), laid.study);
        store.merge(folder.path(order.first), laid, false);
        store.merge(folder.path(order.second), laid, false);
        EXPECT_EQ(identities(store.rows(laid)), identities({computed[0]})) << order.first;
    }
}

TEST_F(StoreTest, FilesOfSomethingElseAreRefusedUnchanged) {
    const std::string junk = folder.write("junk.db", std::string(5000, 'x'));
    EXPECT_THAT(messageOf<LogError>([&] { open("junk.db"); }),
                HasSubstr("expected a file of rows of a study"));
    EXPECT_EQ(folder.read("junk.db"), std::string(5000, 'x'));
    fill("a.db", 0, 1);
    const StudyFile other = load(usual("2"), "other");
    EXPECT_THAT(messageOf<LogError>([&] { Store(folder.path("a.db"), other); }),
                HasSubstr("has the rows of study 'small', expected those of 'other'"));
    EXPECT_THAT(messageOf<LogError>([&] { Store(folder.path("no_folder/a.db"), other); }),
                HasSubstr("no_folder"));
    Store store(folder.path("b.db"), laid.study);
    EXPECT_THAT(messageOf<LogError>([&] { store.merge(junk, laid, false); }), HasSubstr("junk.db"));
}

}  // namespace store_test
}  // namespace slamot::study

#include "StudyFolder.h"
#include "slamot/rawlog/LogError.h"
#include "slamot/study/Store.h"
#include "support/Expect.h"

namespace slamot::study {
namespace {

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
    EXPECT_EQ(store.done(laid, false), keysOf(laid));
    EXPECT_EQ(rows[0].build, laid.configs[0].build);
}

TEST_F(StoreTest, KeepsWhatIsThereAndErasesOnDemand) {
    Store store(folder.path("a.db"), laid.study);
    store.add(computed[0]);
    Row other = computed[0];
    other.status = "failed";
    store.add(other);
    EXPECT_EQ(store.count(), 1u);
    EXPECT_EQ(store.rows(laid).at(0).status, "complete");
    store.erase({computed[0].key});
    EXPECT_EQ(store.count(), 0u);
    store.add(other);
    EXPECT_EQ(store.rows(laid).at(0).status, "failed");
}

TEST_F(StoreTest, RowsOfAnEarlierFormOfTheStudyAreLeftOut) {
    fill("a.db", 0, 8);
    std::string text = usual("2");
    const Plan changed = plan(text.replace(text.find("max_range = 15"), 14, "max_range = 16"));
    const Store store(folder.path("a.db"), changed.study);
    EXPECT_EQ(store.count(), 8u);
    EXPECT_EQ(store.rows(changed).size(), 4u);
    EXPECT_EQ(store.done(changed, false).size(), 4u);
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
    EXPECT_THAT(messageOf<LogError>([&] { store.done(laid, false); }), HasSubstr("1 of its 2 rows"));
    EXPECT_EQ(store.done(laid, true).size(), 2u);
}

TEST_F(StoreTest, MergesAndRefusesContradictions) {
    fill("a.db", 0, 5);
    fill("b.db", 3, 8);
    {
        Store store(folder.path("all.db"), laid.study);
        store.merge({folder.path("a.db"), folder.path("b.db")});
        store.merge({folder.path("a.db")});
        EXPECT_EQ(identities(store.rows(laid)), identities(computed));
    }
    {
        Store store(folder.path("c.db"), laid.study);
        Row row = computed[2];
        row.metrics["robot.position.rmse"] = std::nextafter(row.metrics.at("robot.position.rmse"), 1e9);
        store.add(row);
    }
    Store store(folder.path("all.db"), laid.study);
    const std::string told = messageOf<LogError>([&] { store.merge({folder.path("c.db")}); });
    EXPECT_THAT(told, HasSubstr("c.db"));
    EXPECT_THAT(told, HasSubstr(computed[2].variant + " on " + computed[2].source));
    EXPECT_THAT(messageOf<LogError>([&] { store.merge({folder.path("gone.db")}); }),
                HasSubstr("gone.db: is not there"));
}

TEST_F(StoreTest, FilesOfSomethingElseAreRefusedUnchanged) {
    const std::string junk = folder.write("junk.db", std::string(5000, 'x'));
    EXPECT_THAT(messageOf<LogError>([&] { open("junk.db"); }), HasSubstr("junk.db"));
    EXPECT_EQ(folder.read("junk.db"), std::string(5000, 'x'));
    fill("a.db", 0, 1);
    const StudyFile other = load(usual("2"), "other");
    EXPECT_THAT(messageOf<LogError>([&] { Store(folder.path("a.db"), other); }),
                HasSubstr("has the rows of study 'small', expected those of 'other'"));
    EXPECT_THAT(messageOf<LogError>([&] { Store(folder.path("no_folder/a.db"), other); }),
                HasSubstr("no_folder"));
    Store store(folder.path("b.db"), laid.study);
    EXPECT_THAT(messageOf<LogError>([&] { store.merge({junk}); }), HasSubstr("junk.db"));
}

}  // namespace
}  // namespace slamot::study

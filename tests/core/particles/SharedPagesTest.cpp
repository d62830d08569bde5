#include <gtest/gtest.h>

#include <map>

#include "slamot/core/particles/PointSight.h"
#include "slamot/core/particles/SharedPages.h"
#include "slamot/core/random/RandomStream.h"

namespace slamot {
namespace shared_pages_test {

struct Item {
    LandmarkId id;
    GaussianPoint point;
};
using Pages = SharedPages<Item>;

Item itemAt(std::int64_t id, double x, double y) {
    return {LandmarkId{id}, {{x, y}, Matrix2::Identity()}};
}

Pages row(int count, std::uint64_t owner = 1) {
    Pages pages;
    pages.renew(owner);
    for (int i = 0; i < count; ++i) pages.append(itemAt(2 * i, i, 0));
    return pages;
}

TEST(SharedPagesTest, FindsByIdAndByPlace) {
    const Pages pages = row(100);
    EXPECT_EQ(pages.size(), 100);
    for (int i = 0; i < 100; ++i) {
        const Item* item = pages.find(LandmarkId{2 * i});
        ASSERT_NE(item, nullptr);
        EXPECT_EQ(item->point.mean.x(), i);
        EXPECT_EQ(pages.find(LandmarkId{2 * i + 1}), nullptr);
    }
    EXPECT_EQ(pages.find(LandmarkId{-1}), nullptr);
    EXPECT_EQ(Pages().find(LandmarkId{0}), nullptr);

    std::vector<std::int64_t> near;
    pages.forEachNear({50, 0}, 2.5, [&](Pages::Place, const Item& item) { near.push_back(item.id.value); });
    EXPECT_EQ(near, (std::vector<std::int64_t>{96, 98, 100, 102, 104}));
}

TEST(SharedPagesTest, CopiesShareUntilOneWrites) {
    Pages a = row(64);
    Pages b = a;
    b.renew(2);
    a.renew(3);
    EXPECT_EQ(a.find(LandmarkId{0}), b.find(LandmarkId{0}));  // one item in memory

    Pages::Place place;
    ASSERT_TRUE(b.locate(LandmarkId{40}, place));
    b.write(place).point.mean = {7, 7};
    b.moved(place);
    EXPECT_EQ(a.find(LandmarkId{40})->point.mean, Vector2(20, 0));
    EXPECT_EQ(b.find(LandmarkId{40})->point.mean, Vector2(7, 7));
    EXPECT_EQ(a.find(LandmarkId{0}), b.find(LandmarkId{0}));    // another page: still shared
    EXPECT_NE(a.find(LandmarkId{42}), b.find(LandmarkId{42}));  // the same page
    EXPECT_EQ(b.bytes()[0] * 4, b.bytes()[1]);

    // What it owns it writes to in place.
    const Item* before = b.find(LandmarkId{40});
    b.write(place).point.mean = {8, 8};
    EXPECT_EQ(b.find(LandmarkId{40}), before);

    // A moved item is found where it is.
    int found = 0;
    b.forEachNear({8, 8}, 0.1, [&](Pages::Place, const Item&) { ++found; });
    EXPECT_EQ(found, 0);
    b.moved(place);
    b.forEachNear({8, 8}, 0.1, [&](Pages::Place, const Item&) { ++found; });
    EXPECT_EQ(found, 1);
}

TEST(SharedPagesTest, SweepsAllPagesInTurn) {
    Pages pages = row(100);
    const auto isGone = [](const Item& item) { return item.point.mean.x() >= 40; };
    for (int calls = pages.pages(); calls > 0; --calls) {
        std::vector<Pages::Place> gone;
        pages.sweep(gone, isGone);
        for (const Pages::Place place : gone) EXPECT_TRUE(isGone(pages.at(place)));
        EXPECT_LE(gone.size(), static_cast<std::size_t>(Pages::page_capacity));
        pages.remove(gone);
    }
    // Pages move up when one of them goes, so that a round may miss some; two do not.
    for (int calls = 2 * pages.pages(); calls > 0; --calls) {
        std::vector<Pages::Place> gone;
        pages.sweep(gone, isGone);
        pages.remove(gone);
    }
    EXPECT_EQ(pages.size(), 40);
    Pages none;
    std::vector<Pages::Place> gone;
    none.sweep(gone, isGone);
    EXPECT_TRUE(gone.empty());
}

TEST(SharedPagesTest, AppendingToASharedPageLeavesTheOtherAsItWas) {
    Pages a = row(3);
    Pages b = a;
    a.renew(2);
    b.renew(3);
    a.append(itemAt(100, 1, 1));
    b.append(itemAt(101, 2, 2));
    EXPECT_EQ(a.size(), 4);
    EXPECT_EQ(b.size(), 4);
    EXPECT_NE(a.find(LandmarkId{100}), nullptr);
    EXPECT_EQ(a.find(LandmarkId{101}), nullptr);
    EXPECT_EQ(b.find(LandmarkId{100}), nullptr);
}

// Many copies that write, append, move and remove, against plain maps.
TEST(SharedPagesTest, AgreesWithPlainMapsWhateverIsDone) {
    constexpr int copies = 5;
    std::vector<Pages> pages(copies);
    std::vector<std::map<std::int64_t, Vector2>> plain(copies);
    std::uint64_t owner = 0;
    std::int64_t next = 0;
    for (Pages& each : pages) each.renew(++owner);
    RandomStream random(1, RandomPurpose::test);
    const auto draw = [&](int n) { return static_cast<std::size_t>(random.uniform() * n); };

    for (int step = 0; step < 4000; ++step) {
        const std::size_t k = draw(copies);
        const double action = random.uniform();
        if (action < 0.5) {
            const Vector2 at(random.uniform(-50, 50), random.uniform(-50, 50));
            pages[k].append(itemAt(next, at.x(), at.y()));
            plain[k][next++] = at;
        } else if (action < 0.7 && !plain[k].empty()) {
            auto some = plain[k].begin();
            std::advance(some, draw(static_cast<int>(plain[k].size())));
            Pages::Place place;
            ASSERT_TRUE(pages[k].locate({some->first}, place));
            some->second += Vector2(random.normal(), random.normal());
            pages[k].write(place).point.mean = some->second;
            pages[k].moved(place);
        } else if (action < 0.95) {
            std::vector<Pages::Place> gone;
            for (auto each = plain[k].begin(); each != plain[k].end();) {
                Pages::Place place;
                if (random.uniform() < 0.02 && pages[k].locate({each->first}, place)) {
                    gone.push_back(place);
                    each = plain[k].erase(each);
                } else {
                    ++each;
                }
            }
            pages[k].remove(gone);
        } else {
            const std::size_t from = draw(copies);
            if (from == k) continue;
            pages[k] = pages[from];
            plain[k] = plain[from];
            pages[k].renew(++owner);
            pages[from].renew(++owner);
        }
        if (step % 50) continue;
        for (std::size_t i = 0; i < copies; ++i) {
            ASSERT_EQ(pages[i].size(), static_cast<int>(plain[i].size()));
            std::int64_t last = -1;
            pages[i].forEach([&](const Item& item) {
                EXPECT_LT(last, item.id.value);
                last = item.id.value;
                EXPECT_EQ(item.point.mean, plain[i].at(item.id.value));
            });
            int near = 0, expected = 0;
            pages[i].forEachNear({5, 5}, 20, [&](Pages::Place, const Item&) { ++near; });
            for (const auto& [id, at] : plain[i]) {
                expected += (at - Vector2(5, 5)).squaredNorm() <= 400;
                EXPECT_NE(pages[i].find({id}), nullptr);
            }
            EXPECT_EQ(near, expected);
            // Removing does not leave rows of almost empty pages behind.
            EXPECT_LE(pages[i].pages(), 2 + 4 * pages[i].size() / Pages::page_capacity +
                                            pages[i].size() / (Pages::page_capacity / 4));
        }
    }
}

}  // namespace shared_pages_test
}  // namespace slamot

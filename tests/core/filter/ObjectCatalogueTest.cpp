#include <gtest/gtest.h>

#include <set>

#include "slamot/core/filter/ObjectCatalogue.h"

namespace slamot {
namespace object_catalogue_test {

ObjectLifeRecord life() {
    return {ObjectKind::landmark, Existence(LifeParameters{}), 0, {}};
}

std::vector<std::int64_t> idsOf(const ObjectCatalogue& objects) {
    std::vector<std::int64_t> out;
    for (const TrackRecord& track : objects.tracks()) out.push_back(track.id.value);
    return out;
}

TEST(ObjectCatalogueTest, LandmarkIdsAreNeverUsedAgain) {
    ObjectCatalogue objects;
    std::set<std::int64_t> used;
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 5; ++i) {
            LandmarkRecord& record = objects.addLandmark(100 * round + i, {}, {});
            EXPECT_TRUE(used.insert(record.id.value).second);
            objects.giveLife(record, life());
            objects.place(record.block, {0, 0});
        }
        // The newest goes too: its number does not come back.
        for (const LandmarkId id : {objects.landmarks().back().id, objects.landmarks()[0].id})
            objects.removeLandmark(id);
    }
    EXPECT_EQ(used.size(), 100u);
    EXPECT_EQ(objects.landmarks().size(), 60u);
    EXPECT_EQ(objects.positions().size(), 60);
    for (const LandmarkRecord& record : objects.landmarks()) {
        EXPECT_EQ(objects.landmark(record.id), &record);
        EXPECT_EQ(objects.landmarkOf(record.block), &record);
    }
}

TEST(ObjectCatalogueTest, WhatIsRemovedIsFoundNoMore) {
    ObjectCatalogue objects;
    const LandmarkId first = objects.addLandmark(1, {7}, {}).id, second = objects.addLandmark(2, {8}, {}).id,
                     nameless = objects.addLandmark(3, {}, {}).id;
    objects.removeLandmark(first);
    EXPECT_EQ(objects.landmark(first), nullptr);
    EXPECT_EQ(objects.landmarkOf(1), nullptr);
    EXPECT_EQ(objects.landmarkBySource({7}), nullptr);
    EXPECT_EQ(objects.landmarkBySource({8})->id, second);
    EXPECT_EQ(objects.landmarkBySource({}), nullptr) << "no identity is nobody's";
    EXPECT_EQ(objects.landmarkOf(3)->id, nameless);
    // The same identity again is another landmark.
    EXPECT_EQ(objects.addLandmark(4, {7}, {}).id.value, 3);
    EXPECT_EQ(objects.landmarkBySource({7})->block, 4);

    const TrackId track = objects.addTrack(9, {7}, {}).id;
    EXPECT_EQ(objects.trackBySource({7})->id, track);
    objects.removeTrack(track);
    EXPECT_EQ(objects.track(track), nullptr);
    EXPECT_EQ(objects.trackOf(9), nullptr);
    EXPECT_EQ(objects.trackBySource({7}), nullptr);
}

TEST(ObjectCatalogueTest, ATrackThatGoesOnHasItsOldPlace) {
    ObjectCatalogue objects;
    for (int i = 0; i < 3; ++i) objects.addTrack(10 + i, {}, {});
    objects.removeTrack({1});
    objects.addTrack(20, {}, {});
    TrackRecord& again = objects.addTrack(21, {}, {}, TrackId{1});
    EXPECT_EQ(again.block, 21);
    EXPECT_EQ(idsOf(objects), (std::vector<std::int64_t>{0, 1, 2, 3}));
    EXPECT_EQ(objects.track({1})->block, 21);
    EXPECT_EQ(objects.addTrack(22, {}, {}).id.value, 4);
}

TEST(ObjectCatalogueTest, CountsSightsAndLives) {
    ObjectCatalogue objects;
    LandmarkRecord& landmark = objects.addLandmark(1, {}, Stamp::fromSeconds(1));
    EXPECT_EQ(landmark.seen, 1);
    objects.markSeen(landmark.id, Stamp::fromSeconds(2));
    EXPECT_EQ(landmark.seen, 2);
    EXPECT_EQ(landmark.first_seen, Stamp::fromSeconds(1));
    EXPECT_EQ(landmark.last_seen, Stamp::fromSeconds(2));

    EXPECT_FALSE(objects.living());
    objects.giveLife(landmark, life());
    objects.giveLife(landmark, life());  // counts once
    objects.place(1, {3, 4});
    TrackRecord& track = objects.addTrack(2, {}, {});
    objects.giveLife(track, life());
    objects.removeLandmark(landmark.id);
    EXPECT_TRUE(objects.living());
    objects.removeTrack(track.id);
    EXPECT_FALSE(objects.living());
    EXPECT_EQ(objects.positions().size(), 0);
}

}  // namespace object_catalogue_test
}  // namespace slamot

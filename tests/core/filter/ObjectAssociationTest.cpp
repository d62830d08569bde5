#include <gtest/gtest.h>

#include "slamot/core/filter/JointFilter.h"
#include "slamot/core/filter/ObjectAssociation.h"
#include "support/Scenes.h"

namespace slamot {
namespace object_association_test {

using test::detectionsAt;
using test::seen;

/// A robot at rest that looks twenty times, without noise, at landmarks 8 m ahead, 8 m behind and 3 m aside.
std::size_t landmarksAfterTwentyLooks(double stated_range, double stated_view) {
    JointFilter filter({}, {});
    filter.start({}, {});
    for (int k = 0; k < 20; ++k) {
        if (k > 0) filter.predict(test::odometry(0.1 * (k - 1), 0.1 * k, {}));
        DetectionSet set = detectionsAt(0.1 * k, {seen({}, {8, 0}, ObjectKind::landmark, -1),
                                                  seen({}, {-8, 0.1}, ObjectKind::landmark, -1),
                                                  seen({}, {0, 3}, ObjectKind::landmark, -1)});
        for (RangeBearingSensor& sensor : std::get<RangeBearingSet>(set.measurements).sensors) {
            sensor.max_range = stated_range;
            sensor.field_of_view = stated_view;
        }
        filter.update(set);
    }
    return filter.landmarks().size();
}

TEST(ObjectAssociationTest, ReadingsBeyondTheStatedLimitsFindTheirLandmarks) {
    EXPECT_EQ(landmarksAfterTwentyLooks(20, 2 * pi), 3u);
    EXPECT_EQ(landmarksAfterTwentyLooks(5, 2 * pi), 3u) << "range";
    EXPECT_EQ(landmarksAfterTwentyLooks(20, pi / 2), 3u) << "field of view";
}

}  // namespace object_association_test
}  // namespace slamot

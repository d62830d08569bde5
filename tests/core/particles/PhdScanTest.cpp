#include "slamot/core/particles/PhdScan.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace phd_scan_test {

Vector2 at(double range, double degrees_off) {
    return range * Vector2(std::cos(radians(degrees_off)), std::sin(radians(degrees_off)));
}

PhdView viewOf(double min_range, double max_range, double field_of_view_deg) {
    ScanView view{};
    view.sensor.min_range = min_range;
    view.sensor.max_range = max_range;
    view.sensor.field_of_view = radians(field_of_view_deg);
    PhdMapParameters p;
    p.range_margin = 0.6;
    p.bearing_margin = radians(5);
    p.nearest = 0.3;
    return {view, p};
}

TEST(PhdScanTest, MarginsOfTheFieldOfView) {
    const PhdView ahead = viewOf(0, 30, 180);
    EXPECT_TRUE(ahead.maySee(at(30.5, 0)));
    EXPECT_FALSE(ahead.maySee(at(30.7, 0)));
    EXPECT_TRUE(ahead.surelySees(at(29.3, 0)));
    EXPECT_FALSE(ahead.surelySees(at(29.5, 0)));
    for (const double side : {-1.0, 1.0}) {
        EXPECT_TRUE(ahead.maySee(at(10, side * 94)));
        EXPECT_FALSE(ahead.maySee(at(10, side * 96)));
        EXPECT_TRUE(ahead.surelySees(at(10, side * 84)));
        EXPECT_FALSE(ahead.surelySees(at(10, side * 86)));
    }
    EXPECT_TRUE(ahead.maySee(at(0.1, 0)));
    EXPECT_FALSE(ahead.surelySees(at(0.2, 0)));
    EXPECT_TRUE(ahead.surelySees(at(0.4, 0)));

    // With 352 deg there is nothing that may not be seen beside the view; what is straight behind is not
    // surely seen.
    const PhdView wide = viewOf(2, 30, 352);
    EXPECT_TRUE(wide.maySee(at(10, 180)));
    EXPECT_FALSE(wide.surelySees(at(10, 180)));
    EXPECT_TRUE(wide.surelySees(at(10, 170)));
    EXPECT_TRUE(wide.maySee(at(1.5, 0)));
    EXPECT_FALSE(wide.maySee(at(1.3, 0)));
    EXPECT_FALSE(wide.surelySees(at(2.5, 0)));
    EXPECT_TRUE(wide.surelySees(at(2.7, 0)));
    EXPECT_TRUE(viewOf(0, 30, 360).surelySees(at(10, 180)));

    // A view that the margins leave nothing of.
    const PhdView narrow = viewOf(0, 0.5, 8);
    EXPECT_TRUE(narrow.maySee(at(1, 0)));
    EXPECT_FALSE(narrow.surelySees(at(0.4, 0)));
}

TEST(PhdScanTest, SightsHaveTheirClutterAndNothingBeyondTheWidestGateCounts) {
    PhdMapParameters p;
    p.clutter_per_scan = 3;
    ScanMaker scans(p.clutter(), true);
    DetectionSet set = test::detectionsAt(0, {test::seen({}, {5, 1}, ObjectKind::landmark, 4)});
    RangeBearingSensor& sensor = std::get<RangeBearingSet>(set.measurements).sensors.front();
    sensor.label = "landmarks";
    sensor.min_range = 1;
    sensor.max_range = 11;
    sensor.field_of_view = pi;
    const ParticleScan scan = scans.scan(withoutIdentities(set));
    const PhdScan out(scan, p, GaussianTransform::linear);
    ASSERT_EQ(out.sights.size(), 1u);
    const PhdSight& sight = out.sights.front();
    EXPECT_FALSE(sight.named());
    EXPECT_NEAR(sight.clutter, 3 / (10 * pi), 1e-15);
    EXPECT_TRUE(out.viewOf(sight).looks);
    EXPECT_EQ(out.reach, 11 + p.range_margin);
    EXPECT_TRUE(test::near(sight.point, Vector2(5, 1), 1e-14));
    // At that NIS the largest q there can be, of a component of ordinary weight, gives prune_below of the
    // clutter.
    const double q = std::exp(-0.5 * sight.widest) / (2 * pi * std::sqrt(0.01 * 0.0004));
    EXPECT_NEAR(2 * p.detection_probability * q, p.prune_below * sight.clutter, 1e-12);
}

TEST(PhdScanTest, WeightOfBirths) {
    PhdMapParameters p;
    p.new_per_scan = 0.05;
    p.largest_birth = 0.1;
    p.clutter_per_scan = 5;
    EXPECT_NEAR(p.birthWeight(), 0.05 / 5.05, 1e-15);
    for (const double clutter : {0.0, 0.2}) {
        p.clutter_per_scan = clutter;
        EXPECT_EQ(p.birthWeight(), 0.1);
    }
    p.clutter_per_scan = p.new_per_scan = 0;
    EXPECT_EQ(p.birthWeight(), 0.1);
    EXPECT_EQ(p.clutter().clutter_per_scan, 0.1);
}

}  // namespace phd_scan_test
}  // namespace slamot

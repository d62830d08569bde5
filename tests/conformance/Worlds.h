#pragma once
// The small worlds in which the laws are tried. All of them have one steered robot.
#include "conformance/Play.h"

namespace slamot::conformance {

/// Twenty seconds on most of a circle among 30 landmarks and two movers, all-round view, 1 deg bearings.
sim::Scenario roundTrip();

/// The same without any noise in the world; sensor and odometry go on claiming theirs.
sim::Scenario noiseFree();

/// The same with bearing noise of 6 deg, where the curvature of polar measurements matters.
sim::Scenario roughBearings();

/// Landmarks straight behind a robot that heads along -x: bearings and heading both lie about +-pi.
sim::Scenario behind();

/// Fifty movers that come and go.
sim::Scenario crowd();

/// `play` with what real logs bring: the same object twice in a batch, detections without identity or kind,
/// one right at the sensor, one with an enormous id, and one that is far off.
Play withNuisances(Play play);

}  // namespace slamot::conformance

#include "conformance/Conformance.h"

SLAMOT_CONFORMANCE_SUITE(dead_reckoning, slamot::conformance::Options{})

#include "conformance/Conformance.h"
#include "conformance/Play.h"
#include "support/Expect.h"

namespace slamot {
namespace {

conformance::Options invariant() {
    conformance::Options options;
    options.config = "[ekf_slamot.target]\nnoise_std = 0.1\n";
    return options;
}

conformance::Options classic() {
    conformance::Options options;
    options.plugin = "ekf_slamot";
    options.config = "[ekf_slamot]\nconsistency = classic\n";
    options.nees_exemption = "the classic core is over-confident at large bearing noise";
    return options;
}

}  // namespace
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(ekf_slamot, slamot::invariant())
SLAMOT_CONFORMANCE_SUITE(ekf_slamot_classic, slamot::classic())

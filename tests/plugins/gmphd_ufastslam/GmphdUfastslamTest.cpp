#include "conformance/Conformance.h"
#include "support/Expect.h"
#include "support/Scenes.h"

namespace slamot {
namespace {

conformance::Options sampled() {
    conformance::Options options;
    options.plugin = "gmphd_ufastslam";
    options.kind = conformance::Kind::sampled;
    options.nees_exemption = "particles die out: what the filter has forgotten it takes for certain";
    return options;
}

}  // namespace
}  // namespace slamot

SLAMOT_CONFORMANCE_SUITE(gmphd_ufastslam, slamot::sampled());

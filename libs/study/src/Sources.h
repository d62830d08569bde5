#pragma once
#include "slamot/study/Plan.h"

namespace slamot::study {

bool runsOn(const Variant& variant, const Source& source);

/// `config` with every value of `overrides`, which keep their origins for messages.
Config withOverrides(Config config, const Config& overrides);

}  // namespace slamot::study

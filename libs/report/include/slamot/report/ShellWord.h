#pragma once
#include <string>

namespace slamot::report {

/// A word of a command line that people copy into a shell: quoted where it needs it.
std::string shellWord(const std::string& word);

}  // namespace slamot::report

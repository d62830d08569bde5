#pragma once
#include <exception>
#include <string>

namespace slamot {

/// What an exception says, in one line: MRPT's exceptions come with a call stack.
std::string sentenceOf(const std::exception& error);

}  // namespace slamot

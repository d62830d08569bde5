#include "slamot/core/plugin/ErrorText.h"

#include <mrpt/core/exceptions.h>

#include <algorithm>

namespace slamot {

std::string sentenceOf(const std::exception& error) {
    const auto* with_stack = dynamic_cast<const mrpt::ExceptionWithCallBackBase*>(&error);
    std::string text = with_stack ? with_stack->originalWhat : error.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

}  // namespace slamot

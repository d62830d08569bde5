#include "slamot/core/plugin/ErrorText.h"

#include <gtest/gtest.h>
#include <mrpt/core/exceptions.h>

#include <stdexcept>

namespace slamot {
namespace {

TEST(ErrorText, IsOneLineWithoutMrptsCallStack) {
    EXPECT_EQ(sentenceOf(std::runtime_error("a\nb")), "a b");
    std::string what;
    try {
        THROW_EXCEPTION("no such\nthing");
    } catch (const std::exception& error) {
        what = sentenceOf(error);
    }
    EXPECT_EQ(what, "no such thing");
}

}  // namespace
}  // namespace slamot

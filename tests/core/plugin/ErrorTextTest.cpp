#include <gtest/gtest.h>
#include <mrpt/core/exceptions.h>

#include <stdexcept>
#include <string>

#include "slamot/core/plugin/ErrorText.h"

namespace slamot {
namespace error_text_test {

TEST(ErrorText, IsOneLineWithoutMrptsCallStack) {
    EXPECT_EQ(sentenceOf(std::runtime_error("a\nb")), "a b");
    std::string sentence, what;
    try {
        THROW_EXCEPTION("no such\nthing");
    } catch (const std::exception& error) {
        sentence = sentenceOf(error), what = error.what();
    }
    // MRPT puts the place of the throw before it, in the same line.
    EXPECT_NE(sentence.find("no such thing"), std::string::npos) << sentence;
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    EXPECT_LT(sentence.size(), what.size());
}

}  // namespace error_text_test
}  // namespace slamot

#include <gtest/gtest.h>

#include "slamot/eval/TerminalText.h"

namespace slamot::eval {
namespace terminal_text_test {

TEST(TerminalText, WordsGoToTheNextLineAtTheTerminalsWidth) {
    const std::string forty(40, 'a'), thirty_nine(39, 'b');
    EXPECT_EQ(wrapped(forty + " " + thirty_nine), forty + " " + thirty_nine + "\n");  // 80
    EXPECT_EQ(wrapped(forty + " " + forty), forty + "\n    " + forty + "\n");         // 81
    EXPECT_EQ(wrapped("one two", 2, 4), "  one two\n");
}

TEST(TerminalText, AWordThatIsTooLongKeepsALineOfItsOwn) {
    const std::string word(100, 'a');
    EXPECT_EQ(wrapped("x " + word + " y"), "x\n    " + word + "\n    y\n");
}

}  // namespace terminal_text_test
}  // namespace slamot::eval

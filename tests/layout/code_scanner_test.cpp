#include "code_scanner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::layout {
namespace {

using testing::ElementsAre;

TEST(Strip, BlanksCommentsAndKeepsLines) {
  EXPECT_EQ(strip("a; // b\nc; /* d\ne */ f;"), "a;     \nc;     \n     f;");
}

TEST(Strip, BlanksLiteralsWithTheirEscapes) {
  EXPECT_EQ(strip(R"(f("a\"{", '{', '\'');)"), R"(f("    ", ' ', '  ');)");
  EXPECT_EQ(strip("f(u8\"{\", L'{');"), "f(u8\" \", L' ');");
}

TEST(Strip, KnowsDigitSeparators) {
  EXPECT_EQ(strip("x = 1'000'000; y = 0xF'F; // z"), "x = 1'000'000; y = 0xF'F;     ");
}

TEST(Strip, BlanksRawStrings) {
  EXPECT_EQ(strip("x = R\"a(\" { )\" )a\"; y"), "x =               ; y");
}

TEST(Includes, FindsBothKindsAndSkipsComments) {
  const auto found = includes(
      "#include <a/b.h>\n// #include <no.h>\n#  include \"c.h\"  // why\n/*\n#include <d>\n*/\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].path, "a/b.h");
  EXPECT_FALSE(found[0].quoted);
  EXPECT_EQ(found[1].path, "c.h");
  EXPECT_TRUE(found[1].quoted);
  EXPECT_EQ(found[1].line, 3);
}

TEST(LinesWithWord, NeedsWholeWords) {
  EXPECT_THAT(lines_with_word("sleep\nsleeper\n my_sleep x.sleep(\n", "sleep"), ElementsAre(1, 3));
}

TEST(CountLines, CountsAnUnfinishedLastLine) {
  EXPECT_EQ(count_lines(""), 0);
  EXPECT_EQ(count_lines("a\nb\n"), 2);
  EXPECT_EQ(count_lines("a\nb"), 2);
}

}  // namespace
}  // namespace tether::layout

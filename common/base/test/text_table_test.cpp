#include <gtest/gtest.h>

#include <tether/base/text.h>

namespace tether {
namespace {

TEST(TextTable, AlignsByCharactersNotBytes) {
  EXPECT_EQ(text_table({{"a", "where", "x"}, {"bcd", "cpu × 6", "10.5"}, {"e"}}),
            "a    where       x\n"
            "bcd  cpu × 6  10.5\n"
            "e\n");
}

TEST(TextTable, BecomesListsIfItIsTooWide) {
  const std::vector<std::vector<std::string>> rows = {
      {"stage", "count", "median ms"}, {"detect", "30", "12.5"}, {"decide", "", "0.1"}};
  const std::string table = text_table(rows);
  EXPECT_EQ(text_table(rows, 24), table);
  EXPECT_EQ(text_table(rows, 23),
            "detect\n"
            "  count      30\n"
            "  median ms  12.5\n"
            "\n"
            "decide\n"
            "  median ms  0.1\n");
}

TEST(Wrapped, BreaksBetweenWordsAndKeepsTheBeginOfTheText) {
  EXPECT_EQ(wrapped("a bc def ghij\nk\n", 8), "a bc def\nghij\nk\n");
  EXPECT_EQ(wrapped("a bc def ghij", 13), "a bc def ghij");
  EXPECT_EQ(wrapped("  → speed it up", 12), "  → speed it\n    up");
  EXPECT_EQ(wrapped("  label  one two three", 18), "  label  one two\n         three");
  EXPECT_EQ(wrapped("  a long label  one two", 16), "  a long label\n    one two");
  EXPECT_EQ(wrapped("ä ö ü ß", 5), "ä ö ü\nß");
  EXPECT_EQ(wrapped("/a/path/that/is/long and", 8), "/a/path/that/is/long\nand");
  EXPECT_EQ(wrapped("record  /a/path/that/is/long", 20), "record  /a/path/that/is/long");
  EXPECT_EQ(wrapped("", 8), "");
}

TEST(Columns, DoNotCountColours) {
  EXPECT_EQ(columns_of("\x1b[1;32mFäst\x1b[0m: a"), 7u);
}

TEST(Fixed, HasSoManyDigits) {
  EXPECT_EQ(fixed(0.09765, 4), "0.0977");
  EXPECT_EQ(fixed(2.0, 0), "2");
}

TEST(DistinctText, HasTheDigitsInWhichTwoNumbersDiffer) {
  EXPECT_EQ(distinct_text(5.000000001, 5.0, 4), "5.000000001");
  EXPECT_EQ(distinct_text(5.0, 5.000000001, 4), "5");
  EXPECT_EQ(distinct_text(5.25, 5.0, 2), "5.2");
  EXPECT_EQ(distinct_text(7.0, 7.0, 4), "7");
  EXPECT_EQ(distinct_text(0.1 + 0.2, 0.3, 4), "0.30000000000000004");
}

}  // namespace
}  // namespace tether

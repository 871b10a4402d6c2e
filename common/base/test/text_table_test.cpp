#include <gtest/gtest.h>

#include <tether/base/text_table.h>

namespace tether {
namespace {

TEST(TextTable, AlignsByCharactersNotBytes) {
  EXPECT_EQ(text_table({{"a", "where", "x"}, {"bcd", "cpu × 6", "10.5"}, {"e"}}),
            "a    where       x\n"
            "bcd  cpu × 6  10.5\n"
            "e\n");
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

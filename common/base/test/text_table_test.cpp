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

}  // namespace
}  // namespace tether

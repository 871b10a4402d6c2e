#include <gtest/gtest.h>

#include <tether/base/printable.h>

namespace tether {
namespace {

TEST(Printable, KeepsText) {
  EXPECT_EQ(printable("Gazebo 11.1.0, ODE"), "Gazebo 11.1.0, ODE");
  EXPECT_EQ(printable("Z\xC3\xBCrich \xC2\xA0 \xE2\x82\xAC"),
            "Z\xC3\xBCrich \xC2\xA0 \xE2\x82\xAC");
}

TEST(Printable, ReplacesWhatSteersATerminal) {
  EXPECT_EQ(printable("a\x1b[31mb\nc\rd\x7f"), "a?[31mb?c?d?");
  EXPECT_EQ(printable("a\xC2\x9B"
                      "31m"),
            "a?31m");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a?b");
}

TEST(Printable, HasNoBlanksAtItsEnds) {
  EXPECT_EQ(printable("  a b "), "a b");
  EXPECT_EQ(printable("   "), "");
  EXPECT_EQ(printable(""), "");
}

}  // namespace
}  // namespace tether

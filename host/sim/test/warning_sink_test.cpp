#include <string>

#include <gtest/gtest.h>

#include <tether/sim/world.h>

namespace tether::sim {
namespace {

TEST(WarningSinkTest, GetsOnePrintableLine) {
  std::string got;
  with_printable_lines([&](const std::string& line) { got = line; })(
      "w.sdf:2: joint 'a\nb\x1b[2J'");
  EXPECT_EQ(got, "w.sdf:2: joint 'a?b?[2J'");
}

TEST(WarningSinkTest, StaysEmpty) {
  EXPECT_FALSE(with_printable_lines(nullptr));
}

}  // namespace
}  // namespace tether::sim

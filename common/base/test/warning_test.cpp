#include <vector>

#include <gtest/gtest.h>

#include <tether/base/error.h>

namespace tether {
namespace {

TEST(Warning, GetsToItsSinkPrintable) {
  Warning got;
  const Warning given{Consequence::kMissing, {"w\n.sdf", 2}, "joint 'a\nb\x1b[2J'", "is\nlost"};
  printable_warnings([&](const Warning& warning) { got = warning; })(given);
  EXPECT_EQ(got, (Warning{Consequence::kMissing, {"w?.sdf", 2}, "joint 'a?b?[2J'", "is?lost"}));
  EXPECT_EQ(to_line(got), "w?.sdf:2: joint 'a?b?[2J' is?lost");
  EXPECT_FALSE(printable_warnings(nullptr));
}

TEST(Warning, IsGroupedByConsequenceAndCountedByKindWhereThereAreMany) {
  std::vector<Warning> warnings(
      3, {Consequence::kNoEffect, {"w.sdf", 7}, "plugin 'p'", "is not represented"});
  warnings.push_back(
      {Consequence::kNoEffect, {"w.sdf", 8}, "<script> of visual 'v'", "is ignored"});
  warnings.push_back({Consequence::kMissing, {}, "the profile's sensor 'a'", "is left out"});
  EXPECT_EQ(grouped(warnings, 3),
            "missing from the world (1):\n"
            "  the profile's sensor 'a' is left out\n"
            "no effect here (4): 3 plugin, 1 <script>\n");
  EXPECT_EQ(grouped(std::vector(warnings.begin() + 2, warnings.end() - 1), 2),
            "no effect here (2):\n"
            "  w.sdf:7: plugin 'p' is not represented\n"
            "  w.sdf:8: <script> of visual 'v' is ignored\n");
  EXPECT_EQ(grouped({}, 0), "");
}

}  // namespace
}  // namespace tether

#include "refusals.h"

#include <vector>

#include <gtest/gtest.h>

namespace tether::runner {
namespace {

TEST(Refusals, ShowsTheFirstOnesAndTheNumberOfTheOthers) {
  std::vector<std::string> shown;
  Refusals refusals([&](const std::string& text) { shown.push_back(text); });
  EXPECT_EQ(refusals.last(), "");
  for (const char* peer : {"a", "b"}) refusals.add(peer, "late");
  refusals.close();
  EXPECT_EQ(shown, (std::vector<std::string>{"refused a: late", "refused b: late"}));
  for (int i = 2; i < 1000; ++i) refusals.add("c", std::to_string(i));
  EXPECT_EQ(shown.size(), Refusals::kMostShown);
  refusals.close();
  EXPECT_EQ(shown.back(), "refused 980 more connections");
  EXPECT_EQ(refusals.last(), "999");
}

TEST(Refusals, NeedsNoCallback) {
  Refusals refusals({});
  refusals.add("a", "late");
  refusals.close();
  EXPECT_EQ(refusals.last(), "late");
}

}  // namespace
}  // namespace tether::runner

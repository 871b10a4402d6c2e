#include "refusals.h"

#include <vector>

#include <gtest/gtest.h>

namespace tether::runner {
namespace {

class RefusalsTest : public ::testing::Test {
 protected:
  std::vector<std::string> shown_;
  Refusals refusals_{[this](const std::string& text) { shown_.push_back(text); }};
};

TEST_F(RefusalsTest, ShowsTheFirstOnesAndTheNumberOfTheOthers) {
  for (int i = 0; i < 1000; ++i) refusals_.add("a", std::to_string(i), i % 2 == 0);
  EXPECT_EQ(shown_.size(), Refusals::kMostShown);
  EXPECT_EQ(shown_[1], "refused a: 1");
  refusals_.close();
  EXPECT_EQ(shown_.back(), "refused 980 more connections");
  EXPECT_EQ(refusals_.take_last(), "999");
}

TEST_F(RefusalsTest, DoNotShowTheOneThatEndedTheRun) {
  refusals_.add("a", "late", true);
  EXPECT_TRUE(shown_.empty());
  refusals_.add("b", "later", true);
  EXPECT_EQ(refusals_.take_last(), "later");
  refusals_.close();
  EXPECT_EQ(shown_, std::vector<std::string>{"refused a: late"});
}

TEST_F(RefusalsTest, ShowOneThatDidNotEndTheRun) {
  EXPECT_EQ(refusals_.take_last(), "");
  refusals_.add("a", "late", true);
  refusals_.close();
  EXPECT_EQ(shown_, std::vector<std::string>{"refused a: late"});
}

}  // namespace
}  // namespace tether::runner

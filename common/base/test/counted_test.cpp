#include <gtest/gtest.h>

#include <tether/base/counted.h>

namespace tether {
namespace {

TEST(Counted, IsSingularForOne) {
  EXPECT_EQ(counted(0, "flight"), "0 flights");
  EXPECT_EQ(counted(1, "flight"), "1 flight");
  EXPECT_EQ(counted(2, "flight"), "2 flights");
}

}  // namespace
}  // namespace tether

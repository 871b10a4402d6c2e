#include <cstdio>

#include <gtest/gtest.h>

#include <tether/base/version.h>

namespace tether {
namespace {

TEST(Version, BeginsWithThreeNumbers) {
  int major = -1, minor = -1, patch = -1;
  ASSERT_EQ(std::sscanf(version().data(), "%d.%d.%d", &major, &minor, &patch), 3);
  EXPECT_GE(major + minor + patch, 1);
}

}  // namespace
}  // namespace tether

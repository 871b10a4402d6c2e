#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base/result.h>

namespace tether {
namespace {

TEST(Error, SaysWhere) {
  EXPECT_STREQ(Error(ErrorCode::kBadFile, {"a.toml", 7}, "bad").what(), "a.toml:7: bad");
  EXPECT_STREQ(Error(ErrorCode::kBadFile, {"a.toml", 0}, "bad").what(), "a.toml: bad");
}

TEST(Error, ExitCodesFollowTheDesign) {
  EXPECT_EQ(exit_code(ErrorCode::kUsage), 2);
  EXPECT_EQ(exit_code(ErrorCode::kBadFile), 2);
  EXPECT_EQ(exit_code(ErrorCode::kSetup), 3);
  EXPECT_EQ(exit_code(ErrorCode::kLinkLost), 3);
  EXPECT_EQ(exit_code(ErrorCode::kHung), 3);
  EXPECT_EQ(exit_code(ErrorCode::kInternal), 3);
}

TEST(Result, HoldsAValueOrAFailure) {
  Result<int> good = 3;
  Result<int> bad = Failure{Failure::Kind::kTimeout, "late"};
  ASSERT_TRUE(good.ok());
  EXPECT_EQ(*good, 3);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.failure().kind, Failure::Kind::kTimeout);
  EXPECT_EQ(bad.failure().message, "late");
  EXPECT_TRUE(ok_status().ok());
}

}  // namespace
}  // namespace tether

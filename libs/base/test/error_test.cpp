#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base/result.h>

namespace tether {
namespace {

TEST(Error, SaysWhere) {
  EXPECT_STREQ(Error(ErrorCode::kBadFile, {"a.toml", 7}, "bad").what(), "a.toml:7: bad");
  EXPECT_STREQ(Error(ErrorCode::kBadFile, {"a.toml", 0}, "bad").what(), "a.toml: bad");
}

// Names in a file or from a peer may hold anything.
TEST(Error, IsOnePrintableLine) {
  EXPECT_STREQ(Error(ErrorCode::kBadFile, {"a.toml", 7}, "no key 'a\nb\x1b[2J'").what(),
               "a.toml:7: no key 'a?b?[2J'");
}

TEST(Error, ExitCodesFollowTheDesign) {
  EXPECT_EQ(exit_code(ErrorCode::kUsage), 2);
  EXPECT_EQ(exit_code(ErrorCode::kBadFile), 2);
  EXPECT_EQ(exit_code(ErrorCode::kSetup), 3);
  EXPECT_EQ(exit_code(ErrorCode::kLinkLost), 3);
  EXPECT_EQ(exit_code(ErrorCode::kHung), 3);
  EXPECT_EQ(exit_code(ErrorCode::kInternal), 3);
}

TEST(Failure, IsOnePrintableLine) {
  EXPECT_EQ(Failure(Failure::Kind::kProtocol, "no sensor 'a\nb\x1b[2J'").message,
            "no sensor 'a?b?[2J'");
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

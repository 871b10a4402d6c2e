#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base/result.h>
#include <tether/base_testing/no_more_handles.h>

namespace tether {
namespace {

TEST(Error, CarriesPlaceAndSubject) {
  const Error error = Error(ErrorCode::kBadFile, {"a.toml", 7}, "bad").about("rate_hz");
  EXPECT_STREQ(error.what(), "a.toml:7: bad");
  EXPECT_EQ(error.where().file, "a.toml");
  EXPECT_EQ(error.where().line, 7);
  EXPECT_EQ(error.subject(), "rate_hz");
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

TEST(Handles, ThatAreMissingAreNotTheFilesFault) {
  if (!NoMoreHandles::allows_exceptions()) GTEST_SKIP() << "a sanitizer needs handles for them";
  EXPECT_NO_THROW(require_a_handle_for("/dev/null"));
  EXPECT_NO_THROW(require_a_handle_for("/no/such/file"));
  const NoMoreHandles none;
  try {
    require_a_handle_for("/dev/null");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kSetup);
    EXPECT_STREQ(error.what(),
                 "/dev/null: cannot be opened: Too many open files; allow this process more "
                 "(ulimit -n)");
  }
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

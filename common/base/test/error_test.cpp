#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base/result.h>
#include <tether/base_testing/no_more_handles.h>
#include <tether/base_testing/thrown_error.h>

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

TEST(Error, HasANameAndAnExitCode) {
  const struct {
    ErrorCode code;
    const char* name;
    int exit_code;
  } cases[] = {{ErrorCode::kUsage, "usage", 2},
               {ErrorCode::kBadFile, "bad file", 2},
               {ErrorCode::kSetup, "set-up failed", 3},
               {ErrorCode::kLinkLost, "link lost", 3},
               {ErrorCode::kHung, "hung", 3},
               {ErrorCode::kInternal, "internal error", 3},
               {static_cast<ErrorCode>(9), "unknown", 3}};
  for (const auto& c : cases) {
    EXPECT_EQ(name(c.code), c.name);
    EXPECT_EQ(exit_code(c.code), c.exit_code);
  }
}

// Names in a file or from a peer may have any characters.
TEST(Error, IsOnePrintableLineAsAFailureIs) {
  EXPECT_STREQ(Error(ErrorCode::kBadFile, "no key 'a\nb\x1b[2J'").what(), "no key 'a?b?[2J'");
  EXPECT_EQ(Failure(Failure::Kind::kProtocol, "no key 'a\nb\x1b[2J'").message, "no key 'a?b?[2J'");
}

TEST(RequireAHandleFor, FailsOnlyWithoutFileDescriptors) {
  if (!NoMoreHandles::allows_exceptions()) GTEST_SKIP() << "a sanitizer needs handles for them";
  EXPECT_NO_THROW(require_a_handle_for("/dev/null"));
  EXPECT_NO_THROW(require_a_handle_for("/no/such/file"));
  const NoMoreHandles none;
  const Error error = thrown_error(ErrorCode::kSetup, [] { require_a_handle_for("/dev/null"); });
  EXPECT_EQ(error.where().file, "/dev/null");
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

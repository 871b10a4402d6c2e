#include <exception>

#include <gtest/gtest.h>
#include <sys/resource.h>

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

/// This process may open no more files while it lives.
class NoHandles {
 public:
  NoHandles() {
    getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{0, before_.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
  }
  ~NoHandles() { setrlimit(RLIMIT_NOFILE, &before_); }
  NoHandles(const NoHandles&) = delete;
  NoHandles& operator=(const NoHandles&) = delete;

 private:
  rlimit before_{};
};

TEST(Handles, ThatAreMissingAreNotTheFilesFault) {
  EXPECT_NO_THROW(require_a_handle_for("/dev/null"));
  EXPECT_NO_THROW(require_a_handle_for("/no/such/file"));
  std::exception_ptr refusal;
  {
    const NoHandles none;  // the sanitizers need some to look at an Error
    try {
      require_a_handle_for("/dev/null");
    } catch (...) {
      refusal = std::current_exception();
    }
  }
  ASSERT_TRUE(refusal);
  try {
    std::rethrow_exception(refusal);
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

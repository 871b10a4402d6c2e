#include <set>

#include <gtest/gtest.h>

#include <tether/link/server.h>

namespace tether::link {
namespace {

TEST(Token, Is128BitsInHexAndNeverTheSame) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) {
    const std::string token = make_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 100u);
}

/// Every character counts, the first as much as the last; another length is another token. How long
/// it takes is not measured here: that would tell of the machine. It has no way out but by length,
/// which is no secret.
TEST(Token, ComparesWhole) {
  EXPECT_TRUE(tokens_equal("abcd", "abcd"));
  EXPECT_TRUE(tokens_equal("", ""));
  EXPECT_FALSE(tokens_equal("abcd", "abce"));
  EXPECT_FALSE(tokens_equal("abcd", "bbcd"));
  EXPECT_FALSE(tokens_equal("abcd", "abc"));
  EXPECT_FALSE(tokens_equal("abcd", ""));
}

}  // namespace
}  // namespace tether::link

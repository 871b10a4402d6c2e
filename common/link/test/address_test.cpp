#include <gmock/gmock.h>

#include <tether/link/channel.h>

namespace tether::link {
namespace {

TEST(Address, Parses) {
  using Case = std::pair<std::string, Address>;
  for (const auto& [text, expected] :
       {Case{"127.0.0.1:5200", {"127.0.0.1", 5200}}, Case{"host:0", {"host", 0}},
        Case{"[::1]:65535", {"::1", 65535}}, Case{"[fe80::1%eth0]:1", {"fe80::1%eth0", 1}}}) {
    const auto parsed = parse_address(text);
    ASSERT_TRUE(parsed.ok()) << text;
    EXPECT_EQ(*parsed, expected);
    EXPECT_EQ(to_string(*parsed), text);
  }
}

TEST(Address, RefusesAnythingElseWithTheText) {
  for (const std::string text :
       {"", "host", ":5200", "host:", "host:65536", "host:-1", "host:12x", "::1", "fe80::1:5200",
        "[::1]", "[::1]5200", "[]:5200", "[::1:5", "host:1:2", "host: 5"}) {
    const auto parsed = parse_address(text);
    ASSERT_FALSE(parsed.ok()) << text;
    EXPECT_EQ(parsed.failure().kind, Failure::Kind::kInvalid);
    EXPECT_THAT(parsed.failure().message, testing::HasSubstr("'" + text + "'"));
  }
}

}  // namespace
}  // namespace tether::link

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/scenario/target.h>

namespace tether::scenario {
namespace {

using testing::HasSubstr;

TEST(SshAddress, ParsesAndIsWrittenAgain) {
  struct Case {
    std::string text;
    SshAddress expected;
  };
  for (const Case& c :
       {Case{"ssh://board", {"board", 0}}, Case{"ssh://pi@board", {"pi@board", 0}},
        Case{"ssh://pi@10.0.0.7:2222", {"pi@10.0.0.7", 2222}},
        Case{"ssh://pi@[fe80::1%eth0]:22", {"pi@fe80::1%eth0", 22}},
        Case{"ssh://[::1]", {"::1", 0}},
        Case{"ssh://first.last@my-board.local:65535", {"first.last@my-board.local", 65535}}}) {
    const SshAddress address = parse_ssh_address(c.text);
    EXPECT_EQ(address.destination, c.expected.destination) << c.text;
    EXPECT_EQ(address.port, c.expected.port) << c.text;
    EXPECT_EQ(to_string(address), c.text);
  }
}

TEST(SshAddress, MayEndWithASlash) {
  EXPECT_EQ(to_string(parse_ssh_address("ssh://pi@board/")), "ssh://pi@board");
}

TEST(SshAddress, RefusesWithTheTextAndWhatIsExpected) {
  for (const std::string text : {"",
                                 "board",
                                 "pi@board",
                                 "ssh:board",
                                 "http://board",
                                 "ssh://",
                                 "ssh://pi@",
                                 "ssh://@board",
                                 "ssh://board:",
                                 "ssh://board:0",
                                 "ssh://board:65536",
                                 "ssh://board:22x",
                                 "ssh://board/home",
                                 "ssh://[::1",
                                 "ssh://[::1]22",
                                 "ssh://[]",
                                 "ssh://a b",
                                 "ssh://-oProxyCommand=x",
                                 "ssh://-l@board",
                                 "ssh://pi@-board",
                                 "ssh://$(reboot)@board",
                                 "ssh://board:1:2"}) {
    try {
      parse_ssh_address(text);
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::kUsage) << text;
      EXPECT_THAT(e.what(), HasSubstr("\"" + text + "\""));
      EXPECT_THAT(e.what(), HasSubstr("expected ssh://"));
    }
  }
}

TEST(SshAddress, TakesNoPassword) {
  try {
    parse_ssh_address("ssh://pi:raspberry@board");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("password"));
  }
}

}  // namespace
}  // namespace tether::scenario

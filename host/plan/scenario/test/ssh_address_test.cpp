#include <map>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/target.h>

namespace tether::scenario {
namespace {

TEST(SshAddress, ParsesAndIsWrittenAgain) {
  const std::map<std::string, SshAddress> addresses = {
      {"ssh://board", {"board", 0}},
      {"ssh://pi@board", {"pi@board", 0}},
      {"ssh://pi@10.0.0.7:2222", {"pi@10.0.0.7", 2222}},
      {"ssh://pi@[fe80::1%eth0]:22", {"pi@fe80::1%eth0", 22}},
      {"ssh://[::1]", {"::1", 0}},
      {"ssh://first.last@my-board.local:65535", {"first.last@my-board.local", 65535}}};
  for (const auto& [text, expected] : addresses) {
    const SshAddress address = parse_ssh_address(text);
    EXPECT_EQ(address.destination, expected.destination);
    EXPECT_EQ(address.port, expected.port) << text;
    EXPECT_EQ(to_string(address), text);
  }
  EXPECT_EQ(to_string(parse_ssh_address("ssh://pi@board/")), "ssh://pi@board");
}

TEST(SshAddress, RefusesWhatIsNone) {
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
                                 "ssh://board:1:2",
                                 "ssh://pi:password@board"})
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { parse_ssh_address(text); }).subject(), text);
}

}  // namespace
}  // namespace tether::scenario

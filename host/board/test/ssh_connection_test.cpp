#include "fake_ssh.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/board/ssh_connection.h>

namespace tether::board {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

constexpr Duration kLong = std::chrono::seconds(60);

TEST(SshConnection, RunsScriptsWithTheirInput) {
  const FakeSsh ssh;
  const SshConnection connection(FakeSsh::address());
  const os::Captured said =
      connection.run("read -r first\necho \"$first\"\ncat\nexit 5\n", kLong, "one\ntwo\n");
  EXPECT_EQ(said.out, "one\ntwo\n");
  EXPECT_EQ(said.code, 5);
}

TEST(SshConnection, ShowsNothingOfAScriptInACommandLine) {
  const FakeSsh ssh;
  const SshConnection connection(FakeSsh::address());
  const std::string token = "secret-token";
  const os::Captured said = connection.run(
      "# " + token + "\ngrep -c secret-token /proc/$$/cmdline /proc/$PPID/cmdline\n", kLong);
  EXPECT_THAT(said.out, testing::Not(HasSubstr(":1")));
  EXPECT_THAT(said.out, HasSubstr(":0"));
}

TEST(SshConnection, RemovesItsFolder) {
  const FakeSsh ssh;
  std::filesystem::path folder;
  {
    const SshConnection connection(FakeSsh::address());
    folder = connection.folder();
    EXPECT_TRUE(std::filesystem::exists(folder));
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(SshConnection, ReturnsThePortThatTheBoardAllocates) {
  const FakeSsh ssh;
  EXPECT_EQ(SshConnection(FakeSsh::address()).forward_back(4000), 40123);
}

TEST(SshConnection, IsNotLostWhileItsMasterRuns) {
  const FakeSsh ssh;
  SshConnection connection(FakeSsh::address());
  EXPECT_EQ(connection.lost(), std::nullopt);
}

TEST(SshConnection, NamesTheBoardThatItCannotReach) {
  const FakeSsh ssh;
  ssh.scratch().write("ssh",
                      "echo 'ssh: connect to host board port 22: Connection refused' >&2\n"
                      "exit 255\n");
  EXPECT_THAT(error_message(ErrorCode::kSetup, [] { SshConnection{FakeSsh::address()}; }),
              testing::AllOf(HasSubstr("cannot reach ssh://pi@board: "),
                             EndsWith("start an SSH server there, or give its port")));
}

TEST(SshConnection, EndsWhatRunsWhenAStopIsRequestedUnlessItIsPartOfLeaving) {
  const FakeSsh ssh;
  std::stop_source stop;
  const SshConnection connection(FakeSsh::address(), stop.get_token());
  stop.request_stop();
  EXPECT_TRUE(connection.run("exec sleep 60", kLong).timed_out);
  EXPECT_EQ(connection.run("echo text", kLong, {}, true).out, "text\n");
}

TEST(SshConnection, IsNotMadeOnceAStopIsRequested) {
  const FakeSsh ssh;
  ssh.scratch().write("ssh", "exec sleep 60\n");
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(error_message(ErrorCode::kSetup,
                          [&] { SshConnection(FakeSsh::address(), stop.get_token()); }),
            "interrupted by the user");
}

TEST(ExplainSsh, AdvisesByWhatSshSays) {
  const auto explained = [](const std::string& said) {
    return explain_ssh(said, scenario::parse_ssh_address("ssh://pi@board:2222"));
  };
  EXPECT_EQ(
      explained("Warning: x\nHost key verification failed.\n"),
      "Host key verification failed.; this machine does not know the board's key yet; connect "
      "once by hand: ssh -p 2222 pi@board");
  EXPECT_THAT(explained("@ REMOTE HOST IDENTIFICATION HAS CHANGED! @"),
              EndsWith("ssh-keygen -R board"));
  EXPECT_THAT(explained("pi@board: Permission denied (publickey)."),
              EndsWith("ssh-copy-id -p 2222 pi@board"));
  EXPECT_THAT(explained("ssh: Could not resolve hostname board"),
              EndsWith("check the board's name, or give its address"));
  EXPECT_THAT(explained("ssh: connect to host board port 2222: No route to host"),
              EndsWith("check that the board is on and on the same network"));
  EXPECT_EQ(explained(""), "ssh said nothing; try by hand: ssh -p 2222 pi@board");
}

}  // namespace
}  // namespace tether::board

#include "fake_ssh.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/board/board.h>

namespace tether::board {
namespace {

using testing::HasSubstr;

constexpr Duration kPatience = std::chrono::seconds(60);

TEST(SshConnection, RunsScriptsWithTheirInput) {
  const FakeSsh ssh;
  const SshConnection connection(FakeSsh::address());
  const os::Captured said =
      connection.run("read -r first\necho \"$first\"\ncat\nexit 5\n", kPatience, "one\ntwo\n");
  EXPECT_EQ(said.out, "one\ntwo\n");
  EXPECT_EQ(said.code, 5);
}

TEST(SshConnection, DoesNotShowScriptsInCommandLines) {
  const FakeSsh ssh;
  const SshConnection connection(FakeSsh::address());
  const os::Captured said = connection.run(
      "# secret-token\ngrep -c secret-token /proc/$$/cmdline /proc/$PPID/cmdline\n", kPatience);
  EXPECT_THAT(said.out, testing::AllOf(HasSubstr(":0"), testing::Not(HasSubstr(":1"))));
}

TEST(SshConnection, LastsAsLongAsTheObject) {
  const FakeSsh ssh;
  std::filesystem::path folder;
  {
    SshConnection connection(FakeSsh::address());
    folder = connection.folder();
    EXPECT_TRUE(std::filesystem::exists(folder));
    EXPECT_EQ(connection.lost(), std::nullopt);
    EXPECT_EQ(connection.forward_back(4000), 40123) << "as allocated by the board";
  }
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(SshConnection, SaysWithoutAFullStopWhyItWasLost) {
  const FakeSsh ssh;
  ssh.scratch().write("ssh", R"(for word in "$@"; do
  case $word in ControlPath=*) : >"${word#ControlPath=}" ;; esac
done
until [ -e "$TMPDIR/go" ]; do sleep 0.02; done
echo 'Closed by remote host.' >&2
exit 255
)");
  SshConnection connection(FakeSsh::address());
  ssh.scratch().write("go", "");
  EXPECT_EQ(connection.lost(kPatience),
            "the connection to ssh://pi@board was lost: Closed by remote host");
}

TEST(SshConnection, NamesTheBoardThatItCannotReachOrThatForwardsNoPort) {
  const FakeSsh ssh;
  const SshConnection connection(FakeSsh::address());
  ssh.scratch().write("ssh", "echo 'Connection refused' >&2\nexit 255\n");
  const Error error = thrown_error(ErrorCode::kSetup, [] { SshConnection{FakeSsh::address()}; });
  EXPECT_EQ(error.subject(), "ssh://pi@board");
  EXPECT_THAT(error.what(), HasSubstr("Connection refused"));
  EXPECT_EQ(thrown_error(ErrorCode::kSetup, [&] { connection.forward_back(4000); }).subject(),
            "ssh://pi@board");
}

TEST(SshConnection, AStopRequestEndsCommandsExceptCleanup) {
  const FakeSsh ssh;
  std::stop_source stop;
  const SshConnection connection(FakeSsh::address(), stop.get_token());
  stop.request_stop();
  EXPECT_TRUE(connection.run("exec sleep 60", kPatience).timed_out);
  EXPECT_EQ(connection.run("echo text", kPatience, {}, true).out, "text\n");
}

TEST(SshConnection, AStopRequestEndsConnecting) {
  const FakeSsh ssh;
  ssh.scratch().write("ssh", "exec sleep 60\n");
  std::stop_source stop;
  stop.request_stop();
  thrown_error(ErrorCode::kSetup, [&] { SshConnection(FakeSsh::address(), stop.get_token()); });
}

TEST(ExplainSsh, AdvisesACommandForEachMessage) {
  const std::pair<const char*, const char*> cases[] = {
      {"Warning: x\nHost key verification failed.\n", "ssh -p 2222 pi@board"},
      {"@ REMOTE HOST IDENTIFICATION HAS CHANGED! @", "ssh-keygen -R board"},
      {"pi@board: Permission denied (publickey).", "ssh-copy-id -p 2222 pi@board"},
      {"ssh: Could not resolve hostname board", "address"},
      {"ssh: connect to host board port 2222: Connection refused", "SSH server"},
      {"ssh: connect to host board port 2222: No route to host", "network"},
      {"", "ssh -p 2222 pi@board"}};
  for (const auto& [message, advice] : cases)
    EXPECT_THAT(explain_ssh(message, scenario::parse_ssh_address("ssh://pi@board:2222")),
                HasSubstr(advice));
}

}  // namespace
}  // namespace tether::board

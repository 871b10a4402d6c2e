#include "support/board.h"
#include "support/trials.h"

#include <algorithm>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// A run's token is where its SUT finds it, and nowhere else that lasts or that others can read.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

/// All that was seen of a program and its children while they ran.
struct Watched {
  Output output;
  std::set<std::string> tokens;         ///< in the environment of processes with the mark
  std::set<std::string> command_lines;  ///< of all processes of this machine
  std::string files;                    ///< content of those in the folders that were looked into
};

std::string value_in(const std::string& environment, const std::string& name) {
  const std::string key = '\0' + name + '=';
  const auto at = ('\0' + environment).find(key);
  if (at == std::string::npos) return "";
  const auto begin = at + key.size() - 1;
  return environment.substr(begin, environment.find('\0', begin) - begin);
}

void look_at_processes(Watched& watched, const std::string& mark) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    watched.command_lines.insert(read_text(entry.path() / "cmdline"));
    const std::string environment = read_text(entry.path() / "environ");
    if (value_in(environment, "TETHER_TEST_MARK") != mark) continue;
    const std::string token = value_in(environment, "TETHER_TOKEN");
    if (!token.empty()) watched.tokens.insert(token);
  }
}

std::string all_files(const std::filesystem::path& folder) {
  std::string text;
  std::error_code gone;
  std::filesystem::recursive_directory_iterator entry(folder, gone);
  for (; !gone && entry != std::filesystem::recursive_directory_iterator(); entry.increment(gone))
    if (entry->is_regular_file(gone)) text += read_text(entry->path());
  return text;
}

Watched watch(const Command& command, const std::string& mark,
              const std::vector<std::filesystem::path>& folders = {}) {
  Watched watched;
  Process process(command);
  while (!process.has_ended()) {
    look_at_processes(watched, mark);
    for (const auto& folder : folders) watched.files += all_files(folder);
    std::this_thread::sleep_for(5ms);
  }
  watched.output = process.wait(1s);
  return watched;
}

class Tokens : public testing::Test {
 protected:
  /// With a token from the kernel, and enough time to be looked at.
  Watched fly(const std::filesystem::path& scenario, const std::vector<std::string>& options = {},
              const Variables& environment = {},
              const std::vector<std::filesystem::path>& folders = {}) const {
    const Command paced = with(
        tether({"run", scenario, "--force", "--out", folder_ / "out", "--real-time-factor", "2"},
               mark_),
        options, {{"TETHER_TOKEN", ""}});
    const Watched watched = watch(with(paced, {}, environment), mark_, folders);
    EXPECT_EQ(watched.output.code, 0) << watched.output.err;
    expect_unseen(watched);
    // Messages in a record are compressed: they are searched as text.
    const std::string record = timeless_record(folder_ / "out");
    EXPECT_GT(record.size(), 10'000u);
    for (const std::string& token : watched.tokens) EXPECT_THAT(record, Not(HasSubstr(token)));
    return watched;
  }
  void expect_unseen(const Watched& watched, std::size_t tokens = 1) const {
    ASSERT_EQ(watched.tokens.size(), tokens);
    const std::string left = all_files(folder_.path());
    for (const std::string& token : watched.tokens) {
      EXPECT_EQ(token.size(), 32u);
      EXPECT_THAT(watched.output.out + watched.output.err, Not(HasSubstr(token)));
      EXPECT_TRUE(left.find(token) == std::string::npos);
      EXPECT_TRUE(watched.files.find(token) == std::string::npos);
      for (const std::string& line : watched.command_lines)
        EXPECT_THAT(line, Not(HasSubstr(token)));
    }
  }

  TempFolder folder_;
  std::string mark_ = "tokens" + std::to_string(getpid());
};

TEST_F(Tokens, OfALocalRunAreSeenByNobody) {
  fly(write_hover_scenario(folder_.path(), "good"));
}

TEST_F(Tokens, OfARunUnderTetherExecAreSeenByNobody) {
  const std::string sut = "[\"" + bad_sut_program().string() + "\", \"good\"]";
  fly(write_hover_scenario(folder_.path(), "good",
                           {{sut, "[\"" TETHER_EXEC_PROGRAM "\", " + sut.substr(1)}, kWall}));
}

TEST_F(Tokens, OfACampaignAreNewForEachTrial) {
  write_hover_scenario(folder_.path(), "good",
                       {{"clock = \"cpu\"", "clock = \"cpu\"\nreal_time_factor = 2.0"}});
  const auto campaign = write_campaign(folder_.path(), 1);
  const Watched watched =
      watch(with(tether({"campaign", campaign, "--out", folder_ / "out"}, mark_), {},
                 {{"TETHER_TOKEN", ""}}),
            mark_);
  EXPECT_EQ(watched.output.code, 0) << watched.output.err;
  expect_unseen(watched, 2);
}

/// Nor does the way to a board show it: neither ssh's command line nor a file on either side.
TEST_F(Tokens, OfARunOnABoardAreSeenByNobody) {
  const SshBoard board(mark_);
  board.install("bad_sut", bad_sut_program());
  const Watched watched =
      fly(write_hover_scenario(folder_.path(), "good", {{bad_sut_program().string(), "bad_sut"}}),
          {"--target", board.address()}, board.environment(), {board.folder()});
  EXPECT_FALSE(watched.files.empty());
}

/// The one exception, by purpose, goes to standard error.
TEST_F(Tokens, OfARunThatWaitsArePrintedForTheUserOnly) {
  ExternalRun run(write_hover_scenario(folder_.path(), "good"), folder_ / "out");
  const auto sut = run.start_sut({bad_sut_program(), "good"});
  const Output output = run.wait();
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.err, HasSubstr("TETHER_TOKEN=" + ExternalRun::token()));
  EXPECT_THAT(output.out, Not(HasSubstr(ExternalRun::token())));
  EXPECT_TRUE(all_files(folder_.path()).find(ExternalRun::token()) == std::string::npos);
  EXPECT_TRUE(timeless_record(folder_ / "out").find(ExternalRun::token()) == std::string::npos);
  const Output ended = sut->wait(5s);
  EXPECT_THAT(ended.out + ended.err, Not(HasSubstr(ExternalRun::token())));
}

/// A token that cannot be one may be a real one, mistyped or cut.
TEST_F(Tokens, ThatAreWrongAreNotRepeated) {
  ExternalRun run(write_hover_scenario(folder_.path(), "good"), folder_ / "out");
  const std::string secret = "neverShowThis";
  const std::string wrong[] = {secret, secret + std::string(300, 'x'), secret + "\x01\x1b[31m",
                               secret + "\xff\xfe"};
  for (const std::string& token : wrong) {
    const Output refused =
        run.start_sut({bad_sut_program(), "good"}, {{"TETHER_TOKEN", token}})->wait(20s);
    EXPECT_EQ(refused.code, 3);
    EXPECT_THAT(refused.err, HasSubstr("token"));
    EXPECT_THAT(refused.err, Not(HasSubstr(secret)));
  }
  EXPECT_THAT(run.process().err(), Not(HasSubstr(secret)));
}

/// The run would wait for a SUT in vain.
TEST_F(Tokens, ThatNoSutCouldSendAreRefusedUnrepeated) {
  const Output output = run(
      with(tether({"run", write_hover_scenario(folder_.path(), "good"), "--out", folder_ / "out"}),
           {}, {{"TETHER_TOKEN", "neverShowThis" + std::string(300, 'x')}}));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("TETHER_TOKEN"));
  EXPECT_THAT(output.err + all_files(folder_ / "out"), Not(HasSubstr("neverShowThis")));
}

}  // namespace
}  // namespace tether::system_test

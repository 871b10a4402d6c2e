#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tether/base_testing/scratch_folder.h>
#include <tether/supervisor/supervise.h>

namespace tether::supervisor {
namespace {

using testing::HasSubstr;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// `supervise` changes the whole process: it runs in a child.
class Supervise : public testing::Test {
 protected:
  int run(std::vector<std::string> command, bool verbose = false) {
    return code_of(start({.command = std::move(command), .verbose = verbose}));
  }
  pid_t start(Settings settings, const std::string& output = "output") {
    settings.freezer = FreezerChoice::kSignal;
    const pid_t child = ::fork();
    if (child == 0) ::_exit(run_here(settings, output));
    return child;
  }
  static int code_of(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status);
  }
  std::string said() const { return text_of(scratch_.path("said")); }
  bool left_anything() const { return !std::filesystem::is_empty(scratch_.path("tmp")); }

  ScratchFolder scratch_;

 private:
  int run_here(const Settings& settings, const std::string& output) const {
    std::filesystem::create_directories(scratch_.path("tmp"));
    ::setenv("TMPDIR", scratch_.path("tmp").c_str(), 1);
    if (!settings.uav.empty()) ::setenv("TETHER_UAV", settings.uav.c_str(), 1);
    if (settings.members == 0 && !settings.group.empty())
      static_cast<void>(!std::freopen(scratch_.path(output).c_str(), "w", stdout));
    std::ofstream said(scratch_.path("said"), std::ios::app);
    return supervise(settings, [&](const std::string& text) { said << text << std::endl; });
  }
};

class SuperviseGroup : public Supervise {
 protected:
  pid_t start_group(int members) { return start({.group = socket_, .members = members}); }
  pid_t start_member(const std::string& uav, const std::string& script) {
    return start({.command = {"sh", "-c", script}, .group = socket_, .uav = uav}, uav);
  }
  std::string output_of(const std::string& uav) const { return text_of(scratch_.path(uav)); }

  const std::string socket_ = scratch_.path("group").string();
};

TEST_F(Supervise, ReturnsTheExitCodeOfTheCommandOr128AndItsSignal) {
  EXPECT_EQ(run({"sh", "-c", "test -S \"$TETHER_EXEC\" && exit 7"}), 7);
  EXPECT_FALSE(left_anything());
  EXPECT_EQ(run({"sh", "-c", "kill -KILL $$"}), 137);
}

TEST_F(Supervise, RefusesMissingCommand) {
  EXPECT_EQ(run({"/nowhere/program"}), 2);
  EXPECT_THAT(said(), HasSubstr("/nowhere/program"));
  EXPECT_FALSE(left_anything());
}

TEST_F(Supervise, EndsTheProcessesThatTheCommandLeaves) {
  const std::string file = scratch_.path("pid").string();
  EXPECT_EQ(run({"sh", "-c", "sleep 1000 & echo $! > '" + file + "'"}), 0);
  const std::string left = text_of(scratch_.path("pid"));
  EXPECT_FALSE(std::filesystem::exists("/proc/" + left.substr(0, left.find('\n'))));
}

TEST_F(Supervise, ReportsTheCostOfStopping) {
  EXPECT_EQ(run({"true"}, true), 0);
  EXPECT_THAT(said(), HasSubstr("s of execution time"));
}

// Members may start before the group.
TEST_F(SuperviseGroup, GivesEachMemberItsOutputItsEnvironmentAndItsExitCode) {
  const std::string show = "echo $TETHER_UAV; test -S \"$TETHER_EXEC\" && ";
  const pid_t one = start_member("one", show + "exit 5"),
              other = start_member("other", show + "kill -KILL $$"), group = start_group(2);
  EXPECT_EQ(code_of(one), 5);
  EXPECT_EQ(code_of(other), 137);
  EXPECT_EQ(code_of(group), 0);
  EXPECT_EQ(output_of("one"), "one\n");
  EXPECT_EQ(output_of("other"), "other\n");
  EXPECT_FALSE(left_anything());
  EXPECT_FALSE(std::filesystem::exists(socket_));
}

TEST_F(SuperviseGroup, RefusesACommandThatCannotStartAndASecondProgramForAUav) {
  const pid_t group = start_group(2);
  const pid_t waiting = start_member("one", "echo ready; exec sleep 600");
  while (output_of("one").empty()) std::this_thread::yield();
  EXPECT_EQ(code_of(start_member("one", "exit 0")), 3);
  EXPECT_THAT(said(), HasSubstr("'one'"));
  EXPECT_EQ(code_of(start({.command = {"/nowhere/fly"}, .group = socket_, .uav = "other"})), 2);
  EXPECT_THAT(said(), HasSubstr("/nowhere/fly"));
  ::kill(waiting, SIGTERM);
  EXPECT_EQ(code_of(waiting), 128 + SIGTERM) << "the signal has gone on to the command";
  EXPECT_EQ(code_of(group), 0);
}

TEST_F(SuperviseGroup, EndsTheCommandIfEitherProcessIsKilled) {
  const pid_t group = start_group(2);
  pid_t members[] = {start_member("one", "echo $$; exec sleep 600"),
                     start_member("other", "echo $$; exec sleep 600")};
  while (output_of("one").empty() || output_of("other").empty()) std::this_thread::yield();
  const auto is_there = [&](const std::string& uav) {
    return ::kill(std::stoi(output_of(uav)), 0) == 0;
  };
  ::kill(members[0], SIGKILL);
  while (is_there("one")) std::this_thread::yield();
  EXPECT_TRUE(is_there("other"));
  ::kill(group, SIGKILL);
  EXPECT_EQ(code_of(members[1]), 3);
  while (is_there("other")) std::this_thread::yield();
  for (const pid_t process : {members[0], group}) ::waitpid(process, nullptr, 0);
}

}  // namespace
}  // namespace tether::supervisor

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
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
    const pid_t child = ::fork();
    if (child == 0) ::_exit(run_here(std::move(command), verbose));
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFEXITED(status));
    return WEXITSTATUS(status);
  }
  std::string said() const { return text_of(scratch_.path("said")); }
  bool left_anything() const { return !std::filesystem::is_empty(scratch_.path("tmp")); }

  ScratchFolder scratch_;

 private:
  int run_here(std::vector<std::string> command, bool verbose) const {
    std::filesystem::create_directory(scratch_.path("tmp"));
    ::setenv("TMPDIR", scratch_.path("tmp").c_str(), 1);
    Settings settings;
    settings.command = std::move(command);
    settings.freezer = FreezerChoice::kSignal;
    settings.verbose = verbose;
    std::ofstream said(scratch_.path("said"));
    return supervise(settings, [&](const std::string& text) { said << text << std::endl; });
  }
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

}  // namespace
}  // namespace tether::supervisor

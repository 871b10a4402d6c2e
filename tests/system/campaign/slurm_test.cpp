#include "support/slurm.h"

#include "support/faults.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

/// Campaigns on a real Slurm, whose two nodes are this machine. The protocol itself is tested in
/// host/workers/test.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

class Slurm : public RunTest {
 protected:
  static void SetUpTestSuite() {
    if (!SlurmCluster::is_installed()) return;
    cluster_folder_ = new TempFolder;
    cluster_ = new SlurmCluster(cluster_folder_->path());
  }
  static void TearDownTestSuite() {
    delete cluster_;
    delete cluster_folder_;
    cluster_ = nullptr;
    cluster_folder_ = nullptr;
  }
  void SetUp() override {
    if (cluster_ == nullptr) {
      expect_not_in_ci();
      GTEST_SKIP() << "slurm-wlm and munge are not installed";
    }
    cluster_->wait_until_idle();
  }

  /// A campaign of trials under a scripted clock. With `holds_first`, the SUT of the flight that
  /// begins first idles until it is ended; every later one finishes.
  std::filesystem::path write_small_campaign(int trials, bool holds_first) {
    const std::string program = bad_sut_program();
    const std::string hold = folder_ / "held";
    if (!holds_first) std::filesystem::create_directory(hold);
    write_text(folder_ / "sut.sh", "mkdir '" + hold + "' 2> /dev/null && exec '" + program +
                                       "' idle\nexec '" + program + "' good\n");
    write_hover_scenario(
        folder_.path(), "good",
        {{"\"" + program + "\"", "\"/bin/sh\", \"" + (folder_ / "sut.sh").string() + "\""},
         {"hang_limit_s = 2", "hang_limit_s = 600"},
         kScripted});
    return write_campaign(folder_.path(), trials, "conditions = [\"host\"]\n");
  }
  Command campaign(const std::vector<std::string>& arguments) const {
    return cluster_->in(tether(with({{"campaign"}}, arguments).arguments, mark_));
  }
  Command on_slurm(const std::filesystem::path& file) const {
    return campaign({file, "--slurm", "--out", out_});
  }
  std::filesystem::path trial(int seed, const std::filesystem::path& out) const {
    return out / "hover/host" / ("seed-000" + std::to_string(seed));
  }
  int results(int trials) const {
    int count = 0;
    for (int seed = 1; seed <= trials; ++seed)
      count += std::filesystem::exists(trial(seed, out_) / "result.json");
    return count;
  }
  /// Each flight has finished, and `lost` of them were tried again.
  void expect_all(int trials, int lost) const {
    int tried_again = 0;
    for (int seed = 1; seed <= trials; ++seed) {
      const auto result = read_result(trial(seed, out_));
      EXPECT_EQ(result["end"], "finished") << seed;
      tried_again += result["this_run"]["attempts"] != 1;
    }
    EXPECT_EQ(tried_again, lost);
  }
  /// Waits until all flights but the one that is held have ended. Returns its "JOB_TASK NODE".
  std::string wait_for_held(int trials) const {
    EXPECT_TRUE(wait_until([&] { return results(trials) == trials - 1; }));
    EXPECT_TRUE(wait_until([&] { return cluster_->running().size() == 1; }));
    return cluster_->running().at(0);
  }
  /// The PATH with this shell script in place of sbatch.
  Variables with_sbatch(const std::string& script) const {
    std::filesystem::create_directories(folder_ / "bin");
    write_text(folder_ / "bin/sbatch", "#!/bin/bash\n" + script);
    std::filesystem::permissions(folder_ / "bin/sbatch", std::filesystem::perms(0755));
    return {{"PATH", (folder_ / "bin").string() + ":" + std::getenv("PATH")}};
  }

  static inline TempFolder* cluster_folder_ = nullptr;
  static inline SlurmCluster* cluster_ = nullptr;
};

TEST_F(Slurm, FliesWhatACancelledTaskLostAgainWithTheResultsOfJobs) {
  const auto file = write_small_campaign(4, true);
  Process process(on_slurm(file));
  const std::string held = wait_for_held(4);
  const Output second = run(campaign({"--collect", out_}));
  EXPECT_EQ(second.code, 2) << "the first collector is at work: " << second.err;
  EXPECT_EQ(run(cluster_->in({{"scancel", held.substr(0, held.find(' '))}})).code, 0);
  const Output output = process.wait(60s);
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.err, HasSubstr("lost: hover, host, seed "));
  expect_all(4, 1);

  const auto here = folder_ / "here";
  EXPECT_EQ(run(campaign({file, "--jobs", "2", "--out", here})).code, 0);
  for (int seed = 1; seed <= 4; ++seed) {
    EXPECT_EQ(read_text(trial(seed, out_) / "record.mcap"),
              read_text(trial(seed, here) / "record.mcap"));
    auto a = read_result(trial(seed, out_)), b = read_result(trial(seed, here));
    a.erase("this_run");
    b.erase("this_run");
    EXPECT_EQ(a, b);
  }
}

// The array's tasks get another folder than the one that was named, as if it were not shared.
TEST_F(Slurm, NoticesAFolderThatNodesDoNotShareAndLosesNothing) {
  const auto file = write_small_campaign(2, false);
  const Output output = run(with(on_slurm(file), {},
                                 with_sbatch("exec /usr/bin/sbatch \"${@//" + out_.string() + "/" +
                                             (folder_ / "elsewhere").string() + "}\"\n")));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr(out_.string() + ": "));
  const Output again = run(with(on_slurm(file), {"--resume"}));
  EXPECT_EQ(again.code, 0) << again.err;
  expect_all(2, 0);
}

TEST_F(Slurm, FliesWhatALostNodeHadInHandElsewhere) {
  Process process(on_slurm(write_small_campaign(4, true)));
  const std::string held = wait_for_held(4), node = held.substr(held.find(' ') + 1);
  cluster_->lose_node(node);
  const Output output = process.wait(120s);
  cluster_->start_node(node);
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.err, HasSubstr(node + ": the worker vanished"));
  expect_all(4, 1);
}

TEST_F(Slurm, FliesWhatATimeLimitEndedAgain) {
  const Output output =
      run(with(on_slurm(write_small_campaign(3, true)), {"--slurm-options", "--time=1"}), 240s);
  EXPECT_EQ(output.code, 0) << output.err;
  expect_all(3, 1);
}

/// sbatch that kills `tether` before or after the job is submitted.
class InterruptedSubmission : public Slurm, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(, InterruptedSubmission,
                         testing::Values("kill -KILL $PPID\n",
                                         "/usr/bin/sbatch \"$@\"\nkill -KILL $PPID\n"));

TEST_P(InterruptedSubmission, IsResumedWithOneJob) {
  const auto file = write_small_campaign(3, false);
  EXPECT_EQ(run(with(on_slurm(file), {}, with_sbatch(GetParam()))).code, 128 + SIGKILL);
  const Output output = run(with(on_slurm(file), {"--resume"}));
  EXPECT_EQ(output.code, 0) << output.err;
  expect_all(3, 0);
  std::filesystem::directory_iterator rounds(out_ / ".tether-workers/rounds");
  EXPECT_EQ(std::distance(begin(rounds), end(rounds)), 1);
}

TEST_F(Slurm, IsDetachedCancelledAndCollected) {
  const auto file = write_small_campaign(3, true);
  const Output detached = run(with(on_slurm(file), {"--detach"}));
  EXPECT_EQ(detached.code, 0) << detached.err;
  EXPECT_THAT(detached.err, HasSubstr("--collect"));
  (void)wait_for_held(3);
  EXPECT_EQ(run(campaign({"--cancel", out_})).code, 0);
  const Output output = run(campaign({"--collect", out_}));
  EXPECT_EQ(output.code, 0) << output.err;
  expect_all(3, 0);
}

TEST_F(Slurm, LeavesItsJobsWhenItIsInterrupted) {
  Process process(on_slurm(write_small_campaign(3, true)));
  (void)wait_for_held(3);
  process.signal(SIGINT);
  const Output output = process.wait(20s);
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("--cancel"));
  EXPECT_THAT(cluster_->running(), SizeIs(1));
  EXPECT_EQ(run(campaign({"--cancel", out_})).code, 0);
}

// The shared folder is a small file system.
TEST_F(Slurm, EndsWhereTheSharedFolderIsFullAndGoesOn) {
  std::filesystem::create_directory(out_);
  if (::mount("none", out_.c_str(), "tmpfs", 0, "size=200k") != 0) {
    expect_not_in_ci();
    GTEST_SKIP() << "no file systems may be mounted here";
  }
  const auto file = write_small_campaign(8, false);
  const Output output = run(on_slurm(file), 120s);
  EXPECT_EQ(output.code, 3) << output.err;
  EXPECT_THAT(output.err, HasSubstr("No space left on device"));
  const int before = results(8);
  EXPECT_GT(before, 0);
  EXPECT_EQ(::mount("none", out_.c_str(), "tmpfs", MS_REMOUNT, "size=8m"), 0);
  const Output again = run(with(on_slurm(file), {"--resume"}), 120s);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(results(8), 8);
  cluster_->wait_until_idle();
  EXPECT_EQ(::umount2(out_.c_str(), MNT_DETACH), 0);
}

TEST_F(Slurm, IsRefusedWhereThereIsNone) {
  const auto file = write_small_campaign(1, false);
  const Output absent = run(with(on_slurm(file), {}, {{"PATH", "/nowhere"}}));
  EXPECT_EQ(absent.code, 3);
  EXPECT_THAT(absent.err, HasSubstr("--slurm"));
  EXPECT_FALSE(std::filesystem::exists(out_)) << "nothing was written";
  const Output refused = run(with(on_slurm(file), {"--slurm-options", "--partition=none"}));
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("partition"));
  EXPECT_THAT(refused.err, Not(HasSubstr("\n\n")));
}

}  // namespace
}  // namespace tether::system_test

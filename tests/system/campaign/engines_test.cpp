#include "support/faults.h"
#include "support/slurm.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

/// Campaigns in parts: by GNU parallel, by hand, and on a real Slurm, whose two nodes are this
/// machine. The rules are tested in host/trial/shards/test.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

/// A campaign of trials under a scripted clock.
class Shards : public RunTest {
 protected:
  /// With `holds_first`, the SUT of the flight that begins first idles until it is ended; every
  /// later one finishes.
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
    return tether(with({{"campaign"}}, arguments).arguments, mark_);
  }
  std::filesystem::path trial(int seed, const std::filesystem::path& out) const {
    return out / "hover/host" / ("seed-000" + std::to_string(seed));
  }
  int results(int trials, const std::filesystem::path& out) const {
    int count = 0;
    for (int seed = 1; seed <= trials; ++seed)
      count += std::filesystem::exists(trial(seed, out) / "result.json");
    return count;
  }
  /// Each flight has finished once, and nothing else is left.
  void expect_all(int trials, const std::filesystem::path& out) const {
    for (int seed = 1; seed <= trials; ++seed)
      EXPECT_EQ(read_result(trial(seed, out))["end"], "finished") << seed;
    EXPECT_FALSE(std::filesystem::exists(out / ".shards"));
  }
  /// Both folders have the same results.
  void expect_same(int trials, const std::filesystem::path& one,
                   const std::filesystem::path& other) const {
    for (int seed = 1; seed <= trials; ++seed) {
      EXPECT_EQ(read_text(trial(seed, one) / "record.mcap"),
                read_text(trial(seed, other) / "record.mcap"));
      auto a = read_result(trial(seed, one)), b = read_result(trial(seed, other));
      a.erase("this_run");
      b.erase("this_run");
      EXPECT_EQ(a, b);
    }
  }
};

TEST_F(Shards, OfGnuParallelHaveTheResultsOfOneProcess) {
  if (::access("/usr/bin/parallel", X_OK) != 0) {
    expect_not_in_ci();
    GTEST_SKIP() << "parallel is not installed";
  }
  const auto file = write_small_campaign(5, false);
  const Output output = run(campaign({file, "--engine", "parallel", "--jobs", "3", "--out", out_}));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.err, HasSubstr("5/5  hover, host, seed "));
  expect_all(5, out_);
  const auto here = folder_ / "here";
  EXPECT_EQ(run(campaign({file, "--out", here})).code, 0);
  expect_same(5, out_, here);
}

// Two machines without a common folder: the first is killed, and one of its trials is flown twice.
TEST_F(Shards, AreCollectedFromFoldersAndResumed) {
  const auto file = write_small_campaign(6, true);
  const auto a = folder_ / "a", b = folder_ / "b", all = folder_ / "all";
  {
    Process first(campaign({file, "--shard", "1/2", "--out", a}));
    EXPECT_TRUE(wait_until([&] { return std::filesystem::exists(folder_ / "held"); }));
    first.signal(SIGKILL);
    (void)first.wait(20s);
  }
  EXPECT_EQ(results(6, a), 0);
  EXPECT_EQ(run(campaign({file, "--shard", "2/2", "--out", b})).code, 0);
  EXPECT_EQ(results(6, b), 3);
  const Output some = run(campaign({"--collect", a, b, "--out", all}));
  EXPECT_EQ(some.code, 3);
  EXPECT_THAT(some.err, HasSubstr("3 of 6 trials have no result:\n  hover/host/seed-0001\n"));
  EXPECT_EQ(run(campaign({file, "--shard", "1/2", "--out", a})).code, 0);
  EXPECT_EQ(run(campaign({file, "--shard", "1/3", "--out", b})).code, 0) << "seed 1 again";
  const Output whole = run(campaign({"--collect", all, a, b}));
  EXPECT_EQ(whole.code, 0) << whole.err;
  EXPECT_THAT(whole.err, Not(HasSubstr("flown twice"))) << "the same results";
  EXPECT_EQ(results(6, all), 6);
  EXPECT_EQ(run(campaign({file, "--out", folder_ / "here"})).code, 0);
  expect_same(6, all, folder_ / "here");
  EXPECT_THAT(whole.err, Not(HasSubstr("record is missing")));
  std::filesystem::remove(all / "hover/host/seed-0002/record.mcap");
  EXPECT_THAT(run(campaign({"--collect", all})).err,
              HasSubstr("hover/host/seed-0002: its record is missing"));
}

TEST_F(Shards, AreRefusedWhereOptionsContradict) {
  const auto file = write_small_campaign(1, false);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {file, "--shard", "3/2"},
           {file, "--shard", "1/2", "--engine", "slurm"},
           {file, "--collect", "a"},
           {"--listed", "x"},
           {"--listed", "x", "--shard", "1/2"},
           {"--collect", "a", "--shard", "1/2"},
           {file, "--engine-option", "options=x"},
           {file, "--engine", "parallel", "--engine-option", "x=1"},
           {file, "--engine", "parallell"}}) {
    const Output output = run(campaign(with({words}, {"--out", out_}).arguments));
    EXPECT_EQ(output.code, 2) << testing::PrintToString(words);
    EXPECT_FALSE(std::filesystem::exists(out_));
  }
}

class Slurm : public Shards {
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

  Command on_slurm(const std::filesystem::path& file,
                   const std::vector<std::string>& more = {}) const {
    return cluster_->in(
        campaign(with({{file, "--engine", "slurm", "--out", out_}}, more).arguments));
  }
  /// Waits until all flights but the one that is held have ended. Returns its "JOB_TASK NODE".
  std::string wait_for_held(int trials) const {
    EXPECT_TRUE(wait_until([&] { return results(trials, out_) == trials - 1; }));
    EXPECT_TRUE(wait_until([&] { return cluster_->running().size() == 1; }));
    return cluster_->running().at(0);
  }
  static inline TempFolder* cluster_folder_ = nullptr;
  static inline SlurmCluster* cluster_ = nullptr;
};

TEST_F(Slurm, FliesWhatACancelledTaskLeftAgain) {
  const auto file = write_small_campaign(4, true);
  Process process(on_slurm(file));
  const std::string held = wait_for_held(4);
  EXPECT_EQ(run(on_slurm(file, {"--resume"})).code, 2) << "the first call is at work";
  EXPECT_EQ(run(cluster_->in({{"scancel", held.substr(0, held.find(' '))}})).code, 0);
  const Output output = process.wait(60s);
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(output.err, HasSubstr("1 trial without a result: flying again"));
  expect_all(4, out_);
}

TEST_F(Slurm, FliesWhatALostNodeHadInHandElsewhere) {
  Process process(on_slurm(write_small_campaign(4, true)));
  const std::string held = wait_for_held(4), node = held.substr(held.find(' ') + 1);
  cluster_->lose_node(node);
  const Output output = process.wait(120s);
  cluster_->start_node(node);
  EXPECT_EQ(output.code, 0) << output.err;
  expect_all(4, out_);
}

TEST_F(Slurm, CancelsItsJobWhenItIsInterruptedAndGoesOn) {
  const auto file = write_small_campaign(3, true);
  Process process(on_slurm(file));
  (void)wait_for_held(3);
  process.signal(SIGINT);
  const Output output = process.wait(20s);
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("--resume"));
  EXPECT_TRUE(wait_until([&] { return cluster_->running().empty(); }, 20s));
  EXPECT_EQ(run(on_slurm(file, {"--resume"})).code, 0);
  EXPECT_EQ(results(3, out_), 3);
}

// The shared folder is a small file system.
TEST_F(Slurm, EndsWhereTheSharedFolderIsFullAndGoesOn) {
  std::filesystem::create_directory(out_);
  if (::mount("none", out_.c_str(), "tmpfs", 0, "size=300k") != 0) {
    expect_not_in_ci();
    GTEST_SKIP() << "no file systems may be mounted here";
  }
  const auto file = write_small_campaign(8, false);
  const Output output = run(on_slurm(file), 120s);
  EXPECT_EQ(output.code, 3) << output.err;
  EXPECT_THAT(output.err, HasSubstr("No space left on device"));
  const int before = results(8, out_);
  EXPECT_GT(before, 0);
  EXPECT_EQ(::mount("none", out_.c_str(), "tmpfs", MS_REMOUNT, "size=8m"), 0);
  const Output again = run(on_slurm(file, {"--resume"}), 120s);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(results(8, out_), 8);
  cluster_->wait_until_idle();
  EXPECT_EQ(::umount2(out_.c_str(), MNT_DETACH), 0);
}

TEST_F(Slurm, SaysWhyItRefusesAJob) {
  const Output refused = run(
      on_slurm(write_small_campaign(1, false), {"--engine-option", "options=--partition=none"}));
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("partition"));
  EXPECT_THAT(refused.err, Not(HasSubstr("\n\n")));
}

}  // namespace
}  // namespace tether::system_test

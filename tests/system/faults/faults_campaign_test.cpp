#include "support/faults.h"
#include "support/gazebo.h"

#include <algorithm>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether campaign` is killed or stopped, or meets another one in its folder: finished trials are
/// kept, and --resume goes on (docs/guide/faults.md). Who may use which folder:
/// host/trial/campaign/test/folder_claim_test.cpp.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::StartsWith;

/// All processes with that mark are stopped while this lives.
class Standstill {
 public:
  explicit Standstill(const std::string& mark) : processes_(processes_with_mark(mark)) {
    for (const pid_t pid : processes_) kill(pid, SIGSTOP);
  }
  ~Standstill() {
    for (const pid_t pid : processes_) kill(pid, SIGCONT);
  }
  Standstill(const Standstill&) = delete;
  Standstill& operator=(const Standstill&) = delete;

 private:
  std::vector<pid_t> processes_;
};

/// In the order in which they are run.
const std::vector<std::string> kTrials = {"hover/host/seed-0001", "hover/host/seed-0002",
                                          "hover/host/seed-0003"};

/// The exit code of a campaign whose SUT waits on what Tether does not see.
constexpr int kUnanswered = 3;

/// Three trials under a scripted clock, whose SUT pauses for a second at its end.
class Campaign : public RunTest {
 protected:
  Campaign() { write_hover_scenario(folder_.path(), "pause", {kScripted}); }

  Command campaign(const std::vector<std::string>& options = {},
                   const std::string& out = "out") const {
    return with(tether({"campaign", campaign_, "--out", folder_ / out}, mark_), options);
  }
  std::filesystem::path trial(std::size_t i, const std::string& out = "out") const {
    return folder_ / out / kTrials[i];
  }
  bool has_result(std::size_t i) const {
    return wait_until([&] { return std::filesystem::exists(trial(i) / "result.json"); });
  }
  std::string result(std::size_t i) const { return read_text(trial(i) / "result.json"); }
  void expect_all_finished(const std::string& out = "out") const {
    for (std::size_t i = 0; i < kTrials.size(); ++i) {
      EXPECT_EQ(read_result(trial(i, out))["end"], "finished") << i;
      EXPECT_EQ(audit_code(trial(i, out)), 0) << i;
    }
  }
  void expect_resumes(const std::string& first) const {
    const Output resumed = run(campaign({"--resume"}), 90s);
    EXPECT_EQ(resumed.code, kUnanswered) << resumed.err;
    EXPECT_EQ(result(0), first);
    expect_all_finished();
  }

  const std::filesystem::path campaign_ =
      write_campaign(folder_.path(), 3, "conditions = [\"host\"]\n");
};

/// Killed when the second trial's SUT has printed that; empty: once the first trial is done.
class KilledCampaign : public Campaign, public testing::WithParamInterface<std::string> {};

TEST_P(KilledCampaign, KeepsWhatIsFinishedAndGoesOn) {
  Process process(campaign());
  ASSERT_TRUE(has_result(0)) << process.err();
  ASSERT_TRUE(GetParam().empty() || sut_prints(trial(1), GetParam())) << process.err();
  process.signal(SIGKILL);
  const std::string first = result(0);
  EXPECT_FALSE(std::filesystem::exists(trial(2) / "result.json"));
  // At once: the system may still end the trial that was in flight.
  expect_resumes(first);
}

INSTANTIATE_TEST_SUITE_P(Moments, KilledCampaign, testing::Values("", "joined"),
                         [](const auto& moment) {
                           return moment.param.empty() ? "between_trials" : moment.param;
                         });

// Its record is whole then, but nobody has evaluated it.
TEST_F(Campaign, KilledBeforeATrialsResultIsKeptRunsItAgain) {
  Process process(campaign());
  ASSERT_TRUE(sut_prints(trial(1), "joined")) << process.err();
  const HeldResult held(trial(1));
  ASSERT_TRUE(held.is_reached()) << process.err();
  process.signal(SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(trial(1) / "result.json"));
  EXPECT_EQ(audit_code(trial(1)), 0);
  held.tear();
  expect_resumes(result(0));
  EXPECT_EQ(read_result(trial(1))["this_run"]["attempts"], 1);
}

// The trial that is killed alone is tried once more; the campaign goes on.
TEST_F(Campaign, OutlivesATrialKilledBeforeItsResultIsKept) {
  Process process(campaign());
  ASSERT_TRUE(sut_prints(trial(1), "joined")) << process.err();
  const HeldResult held(trial(1));
  ASSERT_TRUE(held.is_reached()) << process.err();
  const auto run_of_trial = find_process(mark_, "seed-0002");
  ASSERT_TRUE(run_of_trial);
  held.tear();
  kill(*run_of_trial, SIGKILL);
  EXPECT_EQ(process.wait(90s).code, kUnanswered) << process.err();
  EXPECT_TRUE(wait_until_gone(mark_));
  expect_all_finished();
  const auto again = read_result(trial(1))["this_run"];
  EXPECT_EQ(again["attempts"], 2);
  EXPECT_THAT(again["first_failure"].get<std::string>(), HasSubstr("signal 9"));
}

// All of it is stopped for longer than hang_limit_s allows a SUT. The other one flies two at a
// time.
TEST_F(Campaign, ThatWasStoppedIsTheSameAsAnother) {
  Process process(campaign());
  ASSERT_TRUE(sut_prints(trial(1), "pausing")) << process.err();
  {
    const Standstill stopped(mark_);
    std::this_thread::sleep_for(3s);
  }
  EXPECT_EQ(process.wait(90s).code, kUnanswered) << process.err();
  expect_all_finished();
  EXPECT_EQ(run(campaign({"--jobs", "2"}, "alone")).code, kUnanswered);
  for (std::size_t i = 0; i < kTrials.size(); ++i) expect_same_runs(trial(i), trial(i, "alone"));
}

TEST_F(Campaign, KeepsOtherRunsAndCampaignsOutOfItsFolder) {
  Process process(campaign());
  ASSERT_TRUE(has_result(0)) << process.err();
  {
    const Standstill stopped(mark_);
    const auto expect_refused = [&](const Command& command, const std::filesystem::path& folder) {
      const Output output = run(command);
      EXPECT_EQ(output.code, 2);
      EXPECT_THAT(output.err, StartsWith("tether: " + folder.string() + ": "));
      EXPECT_EQ(std::ranges::count(output.err, '\n'), 1) << output.err;
    };
    expect_refused(campaign({"--resume"}), out_);
    expect_refused(campaign({}, ""), folder_ / "");
    for (const std::string& below : {kTrials[1], std::string("aside")})
      expect_refused(tether({"run", folder_ / "hover.toml", "--out", out_ / below}, mark_),
                     out_ / below);
    EXPECT_FALSE(std::filesystem::exists(out_ / "aside"));
  }
  EXPECT_EQ(process.wait(90s).code, kUnanswered) << process.err();
  expect_all_finished();
  for (std::size_t i = 0; i < kTrials.size(); ++i)
    EXPECT_EQ(read_result(trial(i))["this_run"]["attempts"], 1) << i;
}

}  // namespace
}  // namespace tether::system_test

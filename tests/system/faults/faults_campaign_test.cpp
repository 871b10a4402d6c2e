#include "support/faults.h"
#include "support/gazebo.h"

#include <algorithm>
#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether campaign` is killed or stopped, or meets another one in its folder: finished trials are
/// kept, and --resume goes on (docs/guide/faults.md).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// All processes with that mark stand still while this lives.
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

/// Three trials under a scripted clock, whose SUT pauses for a second at its end.
class Campaign : public testing::Test {
 protected:
  Campaign() {
    write_hover_scenario(folder_.path(), "pause",
                         {{"clock = \"cpu\"", "clock = \"scripted\"\ncomputing_ms = 2"}});
    write_text(folder_ / "campaign.toml",
               "name = \"small\"\ntrials = 3\n\n[[scenario]]\nfile = \"hover.toml\"\n"
               "conditions = [\"host\"]\n");
  }
  Command campaign(const std::string& option = "", const std::string& out = "out") const {
    std::vector<std::string> words = {"campaign", folder_ / "campaign.toml", "--out",
                                      folder_ / out};
    if (!option.empty()) words.push_back(option);
    return tether(words, mark_);
  }
  Command flight(const std::filesystem::path& out) const {
    return tether({"run", folder_ / "hover.toml", "--out", out}, mark_);
  }
  static void expect_refused(const Output& output, const std::filesystem::path& folder,
                             const std::string& named = "") {
    EXPECT_EQ(output.code, 2);
    EXPECT_THAT(output.err, StartsWith("tether: " + folder.string() + ": "));
    EXPECT_THAT(output.err, HasSubstr(named));
    EXPECT_EQ(std::count(output.err.begin(), output.err.end(), '\n'), 1) << output.err;
  }
  std::filesystem::path trial(std::size_t i, const std::string& out = "out") const {
    return folder_ / out / kTrials[i];
  }
  bool has_result(std::size_t i) const {
    return wait_until([&] { return std::filesystem::exists(trial(i) / "result.json"); });
  }
  /// Where the SUT of a trial is, by what it has said.
  bool has_said(std::size_t i, const std::string& words) const {
    return wait_until(
        [&] { return read_text(trial(i) / "sut-uav1.log").find(words) != std::string::npos; });
  }
  std::string result(std::size_t i) const { return read_text(trial(i) / "result.json"); }
  void expect_all_finished(const std::string& out = "out") const {
    for (std::size_t i = 0; i < kTrials.size(); ++i) {
      EXPECT_EQ(read_result(trial(i, out))["end"], "finished") << i;
      EXPECT_EQ(run(tether({"audit", trial(i, out) / "record.mcap"})).code, 0) << i;
    }
  }

  const std::string mark_ = mark_of_test();
  TempFolder folder_;
};

struct Moment {
  std::string name;
  std::string said;  ///< by the second trial's SUT; empty: once the first trial is done
};

void PrintTo(const Moment& moment, std::ostream* out) {
  *out << moment.name;
}

class KilledCampaign : public Campaign, public testing::WithParamInterface<Moment> {};

TEST_P(KilledCampaign, KeepsWhatIsFinishedAndGoesOn) {
  Process process(campaign());
  ASSERT_TRUE(has_result(0)) << process.err();
  if (!GetParam().said.empty()) {
    ASSERT_TRUE(has_said(1, GetParam().said)) << process.err();
  }
  process.signal(SIGKILL);
  process.wait(5s);
  EXPECT_TRUE(wait_until_gone(mark_));
  const std::string first = result(0);
  EXPECT_FALSE(std::filesystem::exists(trial(2) / "result.json"));

  const Output resumed = run(campaign("--resume"));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(result(0), first);
  expect_all_finished();
}

INSTANTIATE_TEST_SUITE_P(Moments, KilledCampaign,
                         testing::Values(Moment{"between_trials", ""},
                                         Moment{"in_flight", "joined"},
                                         Moment{"finishing", "pausing"}),
                         [](const auto& moment) { return moment.param.name; });

// Its record is whole then, but nobody has judged it.
TEST_F(Campaign, KilledBeforeATrialsResultIsKeptRunsItAgain) {
  Process process(campaign());
  ASSERT_TRUE(has_said(1, "joined")) << process.err();
  const HeldResult held(trial(1));
  ASSERT_TRUE(wait_until([&] { return held.is_waited_for(); })) << process.err();
  process.signal(SIGKILL);
  process.wait(5s);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(trial(1) / "result.json"));
  EXPECT_EQ(run(tether({"audit", trial(1) / "record.mcap"})).code, 0);
  const std::string first = result(0);

  held.tear();
  const Output resumed = run(campaign("--resume"));
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(result(0), first);
  EXPECT_EQ(read_result(trial(1))["this_run"]["attempts"], 1);
  expect_all_finished();
}

TEST_F(Campaign, OutlivesATrialKilledBeforeItsResultIsKept) {
  Process process(campaign());
  ASSERT_TRUE(has_said(1, "joined")) << process.err();
  const HeldResult held(trial(1));
  ASSERT_TRUE(wait_until([&] { return held.is_waited_for(); })) << process.err();
  const auto run_of_trial = find_process(mark_, "seed-0002");
  ASSERT_TRUE(run_of_trial);
  held.tear();
  kill(*run_of_trial, SIGKILL);
  EXPECT_EQ(process.wait(90s).code, 0) << process.err();
  EXPECT_TRUE(wait_until_gone(mark_));
  expect_all_finished();
  EXPECT_EQ(read_result(trial(1))["this_run"]["attempts"], 2);
}

// The trial that is killed alone is tried once more; the campaign goes on.
TEST_F(Campaign, OutlivesAKilledTrial) {
  Process process(campaign());
  ASSERT_TRUE(has_said(1, "joined")) << process.err();
  const auto run_of_trial = find_process(mark_, "seed-0002");
  ASSERT_TRUE(run_of_trial);
  kill(*run_of_trial, SIGKILL);
  EXPECT_EQ(process.wait(90s).code, 0) << process.err();
  EXPECT_TRUE(wait_until_gone(mark_));
  expect_all_finished();
  const auto again = read_result(trial(1))["this_run"];
  EXPECT_EQ(again["attempts"], 2);
  EXPECT_THAT(again["first_failure"].get<std::string>(), HasSubstr("signal 9"));
}

// All of it stands still longer than hang_limit_s allows a SUT.
TEST_F(Campaign, ThatWasStoppedIsTheSameAsAnother) {
  Process process(campaign());
  ASSERT_TRUE(has_said(1, "pausing")) << process.err();
  {
    const Standstill stopped(mark_);
    std::this_thread::sleep_for(3s);
  }
  EXPECT_EQ(process.wait(90s).code, 0) << process.err();
  expect_all_finished();

  EXPECT_EQ(run(campaign("", "alone")).code, 0);
  for (std::size_t i = 0; i < kTrials.size(); ++i) {
    EXPECT_EQ(timeless_result(trial(i)), timeless_result(trial(i, "alone"))) << i;
    EXPECT_EQ(timeless_record(trial(i)), timeless_record(trial(i, "alone"))) << i;
  }
}

TEST_F(Campaign, KeepsEverybodyElseOutOfItsFolder) {
  const auto out = folder_ / "out";
  Process process(campaign());
  ASSERT_TRUE(has_result(0)) << process.err();
  {
    const Standstill stopped(mark_);
    for (const std::string option : {"", "--resume"}) expect_refused(run(campaign(option)), out);
    expect_refused(run(flight(out)), out);
    for (const std::string& below : {kTrials[0], kTrials[1], kTrials[2], std::string("aside")}) {
      expect_refused(run(flight(out / below)), out / below, out.string());
      expect_refused(run(campaign("", "out/" + below)), out / below, out.string());
    }
    EXPECT_FALSE(std::filesystem::exists(out / "aside"));
    expect_refused(run(campaign("", "")), folder_ / "", out.string());
  }
  EXPECT_EQ(process.wait(90s).code, 0) << process.err();
  expect_all_finished();
  for (std::size_t i = 0; i < kTrials.size(); ++i)
    EXPECT_EQ(read_result(trial(i))["this_run"]["attempts"], 1) << i;
}

TEST_F(Campaign, StaysOutOfTheFolderOfARun) {
  ASSERT_EQ(run(campaign()).code, 0);
  std::filesystem::remove_all(trial(1));
  for (const auto& folder : {folder_ / "out", folder_ / "out" / "aside", folder_ / "fresh"}) {
    Process first(flight(folder));
    ASSERT_TRUE(wait_until([&] {
      return read_text(folder / "sut-uav1.log").find("joined") != std::string::npos;
    })) << first.err();
    const std::string out = folder == folder_ / "fresh" ? "fresh" : "out";
    {
      const Standstill stopped(mark_);
      expect_refused(run(campaign("--resume", out)), folder_ / out, folder.string());
    }
    EXPECT_EQ(first.wait(90s).code, 0) << first.err();
    EXPECT_EQ(run(tether({"audit", folder / "record.mcap"})).code, 0);
  }
  EXPECT_EQ(run(campaign("--resume")).code, 0);
  expect_all_finished();
}

// What is in a trial's folder would count in the campaign's tables.
TEST_F(Campaign, KeepsItsTrialsForItself) {
  ASSERT_EQ(run(campaign()).code, 0);
  const std::string kept = result(1);
  expect_refused(run(flight(trial(1))), trial(1), (folder_ / "out").string());
  EXPECT_EQ(result(1), kept);
  std::filesystem::remove_all(trial(1));
  EXPECT_EQ(run(campaign("--resume")).code, 0);
  expect_all_finished();
}

// As cron jobs are kept apart: `flock .lock tether run ...`.
TEST_F(Campaign, IsNotWhateverElseIsLocked) {
  Command job = flight(folder_ / "out");
  const std::vector<std::string> locked = {"flock", folder_ / ".lock"};
  job.arguments.insert(job.arguments.begin(), locked.begin(), locked.end());
  const Output output = run(job);
  EXPECT_EQ(output.code, 0) << output.err;
}

TEST_F(Campaign, IsNotLookedForFromNowhere) {
  Command lost = flight("out");
  const std::vector<std::string> shell = {"sh", "-c", "mkdir $0; cd $0; rmdir $0; exec \"$@\"",
                                          folder_ / "gone"};
  lost.arguments.insert(lost.arguments.begin(), shell.begin(), shell.end());
  const Output output = run(lost);
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, AllOf(StartsWith("tether: out: "), HasSubstr("--out")));
}

// At once: while the system still ends the trial that was in flight.
TEST_F(Campaign, ThatWasKilledHindersNobody) {
  Process process(campaign());
  ASSERT_TRUE(has_said(1, "joined")) << process.err();
  process.signal(SIGKILL);
  const Output resumed = run(campaign("--resume"), 90s);
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  expect_all_finished();
}

}  // namespace
}  // namespace tether::system_test

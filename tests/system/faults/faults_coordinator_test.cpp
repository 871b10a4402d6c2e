#include "support/faults.h"
#include "support/gazebo.h"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether` itself is killed, or stopped and continued, at each phase (docs/guide/faults.md).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

// ---- Killed

/// A run of bad_sut in a mode, and when it is struck.
struct Moment {
  std::string mode;
  std::string printed;  ///< by the SUT, when it is time; empty: as soon as the SUT runs
};

void PrintTo(const Moment& moment, std::ostream* out) {
  *out << moment.mode;
}

class AtEachPhase : public RunTest, public testing::WithParamInterface<Moment> {};

TEST_P(AtEachPhase, AKilledRunLeavesNoProcessAndNoResult) {
  Process process(flight(GetParam().mode, {"--real-time-factor", "1"}, kEndless));
  ASSERT_TRUE(wait_until([&] { return find_process(mark_, "bad_sut").has_value(); }))
      << process.err();
  ASSERT_TRUE(GetParam().printed.empty() || sut_prints(out_, GetParam().printed)) << process.err();
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait(10s).code, 128 + SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(out_ / "result.json"));
  EXPECT_EQ(run(tether({"report", out_})).code, 2);

  // The folder is as good as new.
  EXPECT_EQ(run(flight()).code, 0);
  EXPECT_EQ(read_record(out_).damage, "");
}

const Moment kMoments[] = {
    {"never_connect", ""}, {"compute", "joined"}, {"sleep_long", "joined"}, {"linger", "finished"}};

INSTANTIATE_TEST_SUITE_P(Phases, AtEachPhase, testing::ValuesIn(kMoments),
                         [](const auto& moment) { return moment.param.mode; });

using Killed = RunTest;

TEST_F(Killed, BeforeItHasKeptItsResultItLeavesAWholeRecord) {
  const HeldResult held(out_);
  Process process(flight());
  ASSERT_TRUE(held.is_reached()) << process.err();
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait(10s).code, 128 + SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(out_ / "result.json"));
  EXPECT_EQ(read_record(out_).footer->end, "finished");
  EXPECT_EQ(audit_code(out_), 0);

  held.tear();
  EXPECT_EQ(run(tether({"report", out_})).code, 2);
  EXPECT_EQ(run(flight()).code, 0);
  EXPECT_EQ(result()["end"], "finished");
  EXPECT_FALSE(std::filesystem::exists(out_ / "result.json.part"));
}

TEST_F(Killed, WhileItsSimulatorStartsItLeavesNoProcess) {
  Process process(gazebo_run(write_hover_scenario(folder_.path(), "good"), out_,
                             stand_in_gazebo(folder_.path(), "silent"), mark_));
  ASSERT_TRUE(wait_until([&] {
    return find_process(mark_, "Xvfb").has_value() && find_process(mark_, "gzserver").has_value();
  })) << process.err();
  process.signal(SIGKILL);
  process.wait(10s);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(out_ / "result.json"));
}

// ---- Stopped and continued

/// Under a scripted clock: what is the same is so to the byte.
class Stopped : public RunTest {
 protected:
  void start(const Command& command) {
    tether_ = std::make_unique<Process>(with(command, {"--real-time-factor", "1"}));
  }
  /// For longer than hang_limit_s, which is 2. `other` is stopped before and goes on after it.
  void stop_for_3_s(std::optional<pid_t> other = {}) {
    if (other) kill(*other, SIGSTOP);
    std::this_thread::sleep_for(200ms);  // in which a simulator is asked for the next step
    tether_->signal(SIGSTOP);
    std::this_thread::sleep_for(3s);
    tether_->signal(SIGCONT);
    std::this_thread::sleep_for(300ms);  // in which it finds no message yet
    if (other) kill(*other, SIGCONT);
  }
  /// Good, with a note, and as if nothing had been.
  void expect_good(const Command& command) {
    tether_->wait(60s);
    EXPECT_TRUE(wait_until_gone(mark_));
    EXPECT_EQ(result()["outcome"], "goal_reached") << tether_->err();
    EXPECT_TRUE(result()["this_run"].contains("notes"));
    const auto stopped = folder_ / "stopped";
    std::filesystem::rename(out_, stopped);
    run(command);
    EXPECT_EQ(result()["outcome"], "goal_reached");
    expect_same_runs(stopped, out_);
  }

  std::unique_ptr<Process> tether_;
};

TEST_F(Stopped, InFlightItChangesNothing) {
  const Command command = flight("good", {}, {kScripted});
  start(command);
  ASSERT_TRUE(sut_prints(out_, "joined"));
  stop_for_3_s();
  expect_good(command);
}

// A laptop's lid, a paused virtual machine: who was stopped together with us did not hang.
TEST_F(Stopped, TogetherWithItsComputingSutItChangesNothing) {
  const Command command = flight("pause", {}, {kScripted});
  start(command);
  ASSERT_TRUE(sut_prints(out_, "pausing"));
  const auto sut = find_process(mark_, "bad_sut");
  ASSERT_TRUE(sut);
  stop_for_3_s(sut);
  expect_good(command);
}

TEST_F(Stopped, TogetherWithItsSimulatorItChangesNothing) {
  const Command command = gazebo_run(write_hover_scenario(folder_.path(), "good", {kScripted}),
                                     out_, stand_in_gazebo(folder_.path(), ""), mark_);
  start(command);
  ASSERT_TRUE(sut_prints(out_, "joined"));
  const auto simulator = find_process(mark_, "gzserver");
  ASSERT_TRUE(simulator);
  stop_for_3_s(simulator);
  expect_good(command);
}

}  // namespace
}  // namespace tether::system_test

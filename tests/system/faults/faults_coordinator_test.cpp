#include "support/faults.h"
#include "support/gazebo.h"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// `tether` itself is killed, or stopped and continued, whatever it does just then
/// (docs/guide/faults.md).
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// ---- Killed

/// A run of bad_sut in a mode, and when it is struck.
struct Moment {
  std::string mode;
  std::string said;  ///< by the SUT, when it is time; empty: as soon as the SUT runs
};

void PrintTo(const Moment& moment, std::ostream* out) {
  *out << moment.mode;
}

class AtEachPhase : public testing::TestWithParam<Moment> {
 protected:
  bool is_time() const {
    const bool runs = find_process(mark_, "bad_sut").has_value();
    return runs &&
           (GetParam().said.empty() ||
            read_text(folder_ / "out/sut-uav1.log").find(GetParam().said) != std::string::npos);
  }
  const std::string mark_ = mark_of_test();
  TempFolder folder_;
};

TEST_P(AtEachPhase, AKilledRunLeavesNoProcessAndNoResult) {
  const auto scenario = write_hover_scenario(
      folder_.path(), GetParam().mode,
      {{"time_limit_s = 5", "time_limit_s = 600"}, {"hang_limit_s = 2", "hang_limit_s = 60"}});
  Process process(
      tether({"run", scenario, "--out", folder_ / "out", "--real-time-factor", "1"}, mark_));
  ASSERT_TRUE(wait_until([&] { return is_time(); })) << process.err();
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait(10s).code, 128 + SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/result.json"));
  EXPECT_EQ(run(tether({"report", folder_ / "out"})).code, 2);

  // The folder is as good as new.
  write_hover_scenario(folder_.path(), "good");
  EXPECT_EQ(run(tether({"run", scenario, "--out", folder_ / "out"})).code, 0);
  EXPECT_EQ(read_record(folder_ / "out").damage, "");
}

const Moment kMoments[] = {
    {"never_connect", ""}, {"compute", "joined"},    {"stubborn", "joined"},
    {"fly_on", "joined"},  {"sleep_long", "joined"}, {"linger", "finished"},
};

INSTANTIATE_TEST_SUITE_P(Phases, AtEachPhase, testing::ValuesIn(kMoments),
                         [](const auto& moment) { return moment.param.mode; });

TEST(KilledBeforeItHasKeptItsResult, LeavesAWholeRecordAndNoResult) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  const auto out = folder / "out";
  const Command command =
      tether({"run", write_hover_scenario(folder.path(), "good"), "--out", out}, mark);
  const HeldResult held(out);
  Process process(command);
  ASSERT_TRUE(wait_until([&] { return held.is_waited_for(); })) << process.err();
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait(10s).code, 128 + SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark));
  EXPECT_FALSE(std::filesystem::exists(out / "result.json"));
  EXPECT_EQ(read_record(out).footer->end, "finished");
  EXPECT_EQ(run(tether({"audit", out / "record.mcap"})).code, 0);

  held.tear();
  const Output report = run(tether({"report", out}));
  EXPECT_EQ(report.code, 2);
  EXPECT_THAT(report.err, HasSubstr(out.string()));
  EXPECT_EQ(run(command).code, 0);
  EXPECT_EQ(read_result(out)["end"], "finished");
  EXPECT_FALSE(std::filesystem::exists(out / "result.json.part"));
}

TEST(KilledWhileItsSimulatorStarts, LeavesNoProcess) {
  const TempFolder folder;
  const std::string mark = mark_of_test();
  Process process(gazebo_run(write_hover_scenario(folder.path(), "good"), folder / "out",
                             stand_in_gazebo(folder.path(), "silent"), mark));
  ASSERT_TRUE(wait_until([&] {
    return find_process(mark, "Xvfb").has_value() && find_process(mark, "gzserver").has_value();
  })) << process.err();
  process.signal(SIGKILL);
  process.wait(10s);
  EXPECT_TRUE(wait_until_gone(mark));
  EXPECT_FALSE(std::filesystem::exists(folder / "out/result.json"));
}

// ---- Stopped and continued

/// Under a scripted clock: what is the same is so to the byte.
class Stopped : public testing::Test {
 protected:
  void start(const std::string& out, const std::string& mode) {
    const auto scenario = write_hover_scenario(
        folder_.path(), mode, {{"clock = \"cpu\"", "clock = \"scripted\"\ncomputing_ms = 2"}});
    out_ = folder_ / out;
    tether_ = std::make_unique<Process>(
        tether({"run", scenario, "--out", out_, "--real-time-factor", "1"}, mark_));
  }
  bool has_said(const std::string& words) const {
    return wait_until(
        [&] { return read_text(out_ / "sut-uav1.log").find(words) != std::string::npos; });
  }
  /// Longer than hang_limit_s, which is 2.
  void stop_for_3_s() {
    tether_->signal(SIGSTOP);
    std::this_thread::sleep_for(3s);
    tether_->signal(SIGCONT);
  }
  void expect_good(bool with_note = true) {
    EXPECT_EQ(tether_->wait(60s).code, 0) << tether_->err();
    EXPECT_TRUE(wait_until_gone(mark_));
    if (with_note) EXPECT_TRUE(read_result(out_)["this_run"].contains("notes"));
  }
  void expect_as_if_alone(const std::string& mode) {
    const auto stopped = out_;
    start("alone", mode);
    EXPECT_EQ(tether_->wait(60s).code, 0) << tether_->err();
    EXPECT_EQ(timeless_result(stopped), timeless_result(out_));
    EXPECT_EQ(timeless_record(stopped), timeless_record(out_));
  }

  const std::string mark_ = mark_of_test();
  TempFolder folder_;
  std::filesystem::path out_;
  std::unique_ptr<Process> tether_;
};

TEST_F(Stopped, BeforeItsSutHasJoinedItChangesNothing) {
  start("stopped", "late");
  ASSERT_TRUE(wait_until([&] { return find_process(mark_, "bad_sut").has_value(); }));
  stop_for_3_s();
  expect_good(false);
  expect_as_if_alone("late");
}

TEST_F(Stopped, InFlightItChangesNothing) {
  start("stopped", "good");
  ASSERT_TRUE(has_said("joined"));
  stop_for_3_s();
  expect_good();
  expect_as_if_alone("good");
}

// A laptop's lid, a paused virtual machine: who was stopped together with us did not hang.
TEST_F(Stopped, TogetherWithItsComputingSutItChangesNothing) {
  start("stopped", "pause");
  ASSERT_TRUE(has_said("pausing"));
  const auto sut = find_process(mark_, "bad_sut");
  ASSERT_TRUE(sut);
  kill(*sut, SIGSTOP);
  stop_for_3_s();
  std::this_thread::sleep_for(300ms);  // in which it looks, and hears nothing yet
  kill(*sut, SIGCONT);
  expect_good();
  expect_as_if_alone("pause");
}

TEST_F(Stopped, WhenItsSutHasFinishedItChangesNothing) {
  start("stopped", "linger");
  ASSERT_TRUE(has_said("finished"));
  stop_for_3_s();
  expect_good();
  EXPECT_EQ(read_result(out_)["outcome"], "goal_reached");
}

TEST_F(Stopped, WithASimulatorOutsideItChangesNothing) {
  const Variables variables = stand_in_gazebo(folder_.path(), "");
  const auto fly = [&](const std::string& out) {
    Command command = gazebo_run(
        write_hover_scenario(folder_.path(), "good",
                             {{"clock = \"cpu\"", "clock = \"scripted\"\ncomputing_ms = 2"}}),
        folder_ / out, variables, mark_);
    command.arguments.insert(command.arguments.end(), {"--real-time-factor", "1"});
    out_ = folder_ / out;
    tether_ = std::make_unique<Process>(command);
  };
  fly("stopped");
  ASSERT_TRUE(has_said("joined"));
  const auto simulator = find_process(mark_, "gzserver");
  ASSERT_TRUE(simulator);
  kill(*simulator, SIGSTOP);
  std::this_thread::sleep_for(200ms);  // in which it is asked for the next step
  stop_for_3_s();
  std::this_thread::sleep_for(300ms);
  kill(*simulator, SIGCONT);
  expect_good();
  const auto stopped = out_;
  fly("alone");
  EXPECT_EQ(tether_->wait(60s).code, 0) << tether_->err();
  EXPECT_EQ(timeless_result(stopped), timeless_result(out_));
  EXPECT_EQ(timeless_record(stopped), timeless_record(out_));
}

}  // namespace
}  // namespace tether::system_test

#include "support/faults.h"

#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>

#include <tether/os/text_file.h>

/// A run that a signal ends.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

/// A run at real time whose SUT flies 400 interactions in 1.5 s, and then behaves by its mode.
class InMidRun : public RunTest {
 protected:
  Output signalled(int signal, const std::string& mode, std::size_t interactions) {
    Process tether(flight(mode, {"--real-time-factor", "1"}, kEndless));
    wait_until_recorded(tether, out_, interactions);
    EXPECT_EQ(processes_with_mark(mark_).size(), 2u);
    tether.signal(signal);
    const Output output = tether.wait(10s);
    EXPECT_TRUE(wait_until_gone(mark_));
    return output;
  }
};

TEST_F(InMidRun, CtrlCEndsItCleanly) {
  expect_failed(signalled(SIGINT, "fly_on", 100), {"interrupted", {}});
  const record::Record record = read_record(out_);
  EXPECT_EQ(record.damage, "");
  EXPECT_EQ(record.footer->end, "interrupted");
  EXPECT_GT(record.footer->st_at_end, from_ns<SimTime>(300'000'000));  // of 100 interactions
  EXPECT_EQ(audit_code(out_), 0);
}

TEST_F(InMidRun, TerminationDoesNotWaitForAStubbornSut) {
  expect_failed(signalled(SIGTERM, "stubborn", 400), {"interrupted", {}});
}

TEST_F(InMidRun, BeingKilledLeavesAReadableRecordAndNoSut) {
  EXPECT_EQ(signalled(SIGKILL, "fly_on", 100).code, 128 + SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(out_ / "result.json"));
  const record::Record record = read_record(out_);
  EXPECT_EQ(record.header.scenario, "hover");
  EXPECT_GE(record.interactions.size(), 100u);
  EXPECT_FALSE(record.footer);
  EXPECT_EQ(audit_code(out_), 1);
}

TEST(BeforeTheSutHasJoined, CtrlCEndsTheRun) {
  const TempFolder folder;
  ExternalRun run(write_hover_scenario(folder.path(), "good"), folder / "out");
  run.process().signal(SIGINT);
  EXPECT_EQ(run.wait(10s).code, 3);
  EXPECT_EQ(read_result(folder / "out")["end"], "interrupted");
}

// libsdformat cannot be stopped while it reads. With this world, it takes some ten seconds.
TEST(InterruptedWorldCheck, EndsAtOnceAndLeavesNothing) {
  const TempFolder folder;
  std::string models;
  for (int i = 0; i < 4000; ++i)
    models +=
        "<model name='m" + std::to_string(i) + "'><static>true</static><link name='l'/></model>\n";
  const std::filesystem::path world = folder / "w.sdf", temporary = folder / "tmp";
  os::write_file_atomically(world,
                            "<sdf version='1.7'><world name='w'>\n" + models + "</world></sdf>");
  std::filesystem::create_directory(temporary);
  for (const int signal : {SIGINT, SIGTERM}) {
    Process process(
        with(tether({"world", "check", world.string()}), {}, {{"TMPDIR", temporary.string()}}));
    ASSERT_TRUE(wait_until([&] { return !std::filesystem::is_empty(temporary); }));
    process.signal(signal);
    EXPECT_EQ(process.wait(5s).code, 128 + signal);
    EXPECT_TRUE(std::filesystem::is_empty(temporary));
  }
}

}  // namespace
}  // namespace tether::system_test

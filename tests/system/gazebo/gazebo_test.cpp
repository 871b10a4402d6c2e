#include "support/gazebo.h"

#include "support/faults.h"
#include "support/gzserver.h"

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Real Gazebo, of build/gazebo-root or the system: flights, and what happens when it fails.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::StartsWith;

/// A machine with other things to do may take long for a first picture.
std::filesystem::path patient_hover(const std::filesystem::path& folder) {
  return write_hover_scenario(folder, "good", {{"hang_limit_s = 2", "hang_limit_s = 30"}});
}

class Gazebo : public RunTest {
 protected:
  void SetUp() override {
    if (const auto why = no_gzserver()) GTEST_SKIP() << *why;
  }
  Output fly(const std::filesystem::path& scenario, const Variables& variables = {}) {
    return run(gazebo_run(scenario, out_, variables, mark_), 100s);
  }
  std::filesystem::path hover() { return patient_hover(folder_.path()); }
  std::string log() { return read_text(out_ / "simulator.log"); }
};

// ---- Flights

TEST_F(Gazebo, FliesAndLeavesNothing) {
  const Output output = fly(hover(), {{"USER", mark_}});
  ASSERT_EQ(output.code, 0) << output.err << log();
  EXPECT_EQ(output.err, "");
  EXPECT_THAT(result()["versions"]["simulator"].get<std::string>(), StartsWith("Gazebo 11"));
  EXPECT_EQ(audit_code(out_), 0);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(std::filesystem::exists(private_folder(out_)));
  // Where Gazebo would keep its shaders.
  EXPECT_FALSE(std::filesystem::exists("/tmp/gazebo-" + mark_ + "-rtshaderlibcache"));
}

TEST_F(Gazebo, ShowsTheAnchorToATask) {
  const Output output = fly(write_face_scenario(folder_.path()));
  EXPECT_EQ(output.code, 0) << output.err << log();
  EXPECT_EQ(audit_code(out_), 0);
}

TEST_F(Gazebo, FliesTwoRunsAtOnce) {
  const TempFolder other;
  Process first(gazebo_run(hover(), out_, {}, mark_));
  Process second(gazebo_run(patient_hover(other.path()), other / "out", {}, mark_));
  EXPECT_EQ(first.wait(100s).code, 0) << log();
  EXPECT_EQ(second.wait(100s).code, 0) << read_text(other / "out/simulator.log");
  EXPECT_NE(private_folder(out_), private_folder(other / "out"));
  EXPECT_TRUE(wait_until_gone(mark_));
}

// ---- Failures

struct Blow {
  std::string name;
  std::string process;  ///< part of its command line
  int signal;
  std::string named;  ///< in the reason
  int hang_limit_s = 30;
};

void PrintTo(const Blow& blow, std::ostream* out) {
  *out << blow.name;
}

class StruckGazebo : public Gazebo, public testing::WithParamInterface<Blow> {};

TEST_P(StruckGazebo, EndsTheRunWithItsReason) {
  EndlessFlight flight(folder_.path(), {}, mark_, GetParam().hang_limit_s);
  const auto process = find_process(mark_, GetParam().process);
  ASSERT_TRUE(process);
  kill(*process, GetParam().signal);
  expect_failed(flight.process().wait(40s), {"simulator_lost", {GetParam().named}});
  EXPECT_EQ(read_record(out_).damage, "");
  EXPECT_FALSE(std::filesystem::exists(private_folder(out_)));
}

const Blow kBlows[] = {
    {"killed", "gzserver", SIGKILL, "signal 9"},
    {"crashed", "gzserver", SIGSEGV, "signal 11"},
    {"stopped", "gzserver", SIGSTOP, "4 s", 4},
    {"blinded", "Xvfb", SIGKILL, "signal 9"},
};

INSTANTIATE_TEST_SUITE_P(Blows, StruckGazebo, testing::ValuesIn(kBlows),
                         [](const auto& blow) { return blow.param.name; });

TEST_F(Gazebo, WhosePortIsInUseSaysSo) {
  const ExternalRun other(hover(), folder_ / "other");  // holds a port
  const std::string master = "http://" + other.address();
  expect_failed(fly(hover(), {{"GAZEBO_MASTER_URI", master}}), {"setup_failed", {master}});
}

TEST_F(Gazebo, WithoutItsPluginDoesNotKeepAnyoneWaiting) {
  write_text(folder_ / "plugin.so", "no library");
  const Output output = fly(hover(), {{"TETHER_GAZEBO_PLUGIN", folder_ / "plugin.so"}});
  expect_failed(output, {"setup_failed", {"plugin.so"}});
}

TEST_F(Gazebo, EndsWithATetherThatIsKilled) {
  EndlessFlight flight(folder_.path(), {}, mark_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  flight.process().signal(SIGKILL);
  EXPECT_TRUE(wait_until_gone(mark_));
  EXPECT_FALSE(has_x_lock(*x_server));
}

TEST_F(Gazebo, EndsWithCtrlC) {
  EndlessFlight flight(folder_.path(), {}, mark_);
  const auto x_server = find_process(mark_, "Xvfb");
  ASSERT_TRUE(x_server);
  flight.process().signal(SIGINT);
  expect_failed(flight.process().wait(20s), {"interrupted", {}});
  EXPECT_FALSE(has_x_lock(*x_server));
  EXPECT_FALSE(std::filesystem::exists(private_folder(out_)));
}

}  // namespace
}  // namespace tether::system_test

#include "support/trials.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

/// Programs of several threads and processes under tether-exec, with the coordinator and the
/// simulator.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Both ways to stop a program.
class Threads : public testing::TestWithParam<std::string> {
 protected:
  /// threads_sut in that mode, as one run; returns the details of its end.
  nlohmann::json fly(const std::string& mode, const std::string& seconds,
                     const std::vector<std::string>& options = {}) {
    const auto out = folder_ / ("run" + std::to_string(++runs_));
    std::vector<std::string> arguments{"run", scenario(mode, seconds), "--out", out, "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Output ended = run(tether(arguments), 60s);
    const std::string said = read_text(out / "sut-uav1.log");
    EXPECT_EQ(ended.code, 0) << ended.err << said;  // so the audit has passed
    return nlohmann::json::parse(said.substr(said.find('{')));
  }

  std::filesystem::path scenario(const std::string& mode, const std::string& seconds) {
    const std::string core = std::thread::hardware_concurrency() > 1 ? R"(, "0")" : "";
    return write_hover_scenario(folder_.path(), mode,
                                {{"[\"" + bad_sut_program().string() + "\", \"" + mode + "\"]",
                                  "[\"" TETHER_EXEC_PROGRAM "\", \"--freezer\", \"" + GetParam() +
                                      "\", \"" THREADS_SUT_PROGRAM "\", \"" + mode + "\", \"" +
                                      seconds + "\"" + core + "]"},
                                 {"clock = \"cpu\"", "clock = \"wall\""},
                                 {"hang_limit_s = 2", "hang_limit_s = 20"}});
  }

  TempFolder folder_;
  int runs_ = 0;
};

/// Keeps simulator and coordinator off the first core, which is the program's.
class OffTheFirstCore {
 public:
  OffTheFirstCore() {
    sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t cores = before_;
    CPU_CLR(0, &cores);
    if (CPU_COUNT(&cores) > 0) sched_setaffinity(0, sizeof cores, &cores);
  }
  ~OffTheFirstCore() { sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_{};
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// How long the counting threads ran, or would have but for others on their core.
double free_to_run_s(const nlohmann::json& details) {
  return details["ran_s"].get<double>() + details["delayed_s"].get<double>();
}

/// Work per second of ET. What others on its core take from the program is not its doing, so each
/// second in which it was free to run counts as one in which it did.
double work_per_s(const nlohmann::json& details) {
  return details["iterations"].get<double>() / details["ran_s"].get<double>() *
         free_to_run_s(details) / details["et_s"].get<double>();
}

// A simulator at a tenth of real time holds the program nine tenths of the time. Would its threads
// go on computing meanwhile, they would do ten times the work in the same ET.
TEST_P(Threads, DoTheSameWorkHoweverSlowTheSimulatorIs) {
  const OffTheFirstCore elsewhere;
  std::vector<double> ratios;
  for (int i = 0; i < 5; ++i) {
    const auto unhindered = fly("count", "0.3");
    const auto held = fly("count", "0.3", {"--real-time-factor", "0.1"});
    for (const auto& details : {unhindered, held}) {
      ASSERT_LE(free_to_run_s(details), 1.03 * details["et_s"].get<double>()) << details;
    }
    ratios.push_back(work_per_s(held) / work_per_s(unhindered));
  }
  EXPECT_NEAR(median(ratios), 1.0, 0.03) << testing::PrintToString(ratios);
}

TEST_P(Threads, ReadFromAChildProcessToo) {
  EXPECT_GE(fly("child", "0.3")["images"].get<int>(), 1);
}

TEST_P(Threads, StandStillInAProcessThatLeftTheGroupToo) {
  fly("apart", "0.3", {"--real-time-factor", "0.1"});
}

// The thread that starts a program waits in the kernel until the new process runs it, and that may
// stand still first.
TEST_P(Threads, StartProgramsMeanwhile) {
  EXPECT_GE(fly("spawn", "2")["started"].get<int>(), 20);
}

TEST_P(Threads, ArePushedMeasurements) {
  const auto details = fly("push", "1");
  for (const char* sensor : {"camera", "imu"}) {
    EXPECT_GE(details[sensor]["count"].get<int>(), 5) << sensor;
    // A thread that waits for its turn on a busy machine comes late, in ET as well, and misses
    // some.
    EXPECT_LE(details[sensor]["lost"].get<int>(), details[sensor]["count"].get<int>()) << sensor;
    EXPECT_EQ(details[sensor]["from_the_future"], 0) << sensor;
  }
}

INSTANTIATE_TEST_SUITE_P(Freezers, Threads, testing::Values("cgroup", "signal"),
                         [](const auto& freezer) { return freezer.param; });

// ---- How it ends, without a coordinator

class Ends : public testing::Test {
 protected:
  Command exec(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all{TETHER_EXEC_PROGRAM};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return {all,
            {{"TETHER_ADDRESS", "127.0.0.1:1"},
             {"TETHER_TOKEN", "token"},
             {"TETHER_TEST_MARK", mark_},
             {"TMPDIR", folder_.path().string()}},
            {}};
  }
  void expect_nothing_left() {
    EXPECT_TRUE(wait_until_gone(mark_));
    for (int i = 0; i < 500 && !std::filesystem::is_empty(folder_.path()); ++i) {
      std::this_thread::sleep_for(10ms);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  }

  TempFolder folder_;
  std::string mark_ = "tether-exec-" + folder_.path().filename().string();
};

TEST_F(Ends, WithTheCodeOfItsCommand) {
  for (const std::string freezer : {"auto", "signal"}) {
    EXPECT_EQ(run(exec({"--freezer", freezer, "sh", "-c", "exit 5"})).code, 5);
    EXPECT_EQ(run(exec({"--freezer", freezer, "sh", "-c", "kill -SEGV $$"})).code, 128 + SIGSEGV);
    EXPECT_EQ(run(exec({"--freezer", freezer, "sh", "-c", "sleep 1000 & exit 0"})).code, 0);
    expect_nothing_left();
  }
}

// A child that has left the process group, and one that has also lost its parent.
TEST_F(Ends, WithThoseWhoLeftTheGroup) {
  for (const std::string freezer : {"auto", "signal"}) {
    EXPECT_EQ(
        run(exec({"--freezer", freezer, "sh", "-c",
                  "setsid sleep 1000 & (setsid sh -c 'sleep 1000 & sleep 1000' &) ; sleep 0.2"}))
            .code,
        0);
    expect_nothing_left();
  }
}

TEST_F(Ends, WithWhatIsWrong) {
  const Output missing = run(exec({"/nowhere/program"}));
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("/nowhere/program"));
  const Output not_executable = run(exec({"/etc/passwd"}));
  EXPECT_EQ(not_executable.code, 2);
  EXPECT_THAT(not_executable.err, HasSubstr("Permission denied"));
  Command unset = exec({"true"});
  unset.environment[0].second = "";
  EXPECT_EQ(run(unset).code, 2);
  expect_nothing_left();
}

TEST_F(Ends, PassingOnWhatInterruptsIt) {
  Process process(
      exec({"sh", "-c", "trap 'exit 9' TERM; echo ready; while :; do sleep 0.1; done"}));
  ASSERT_TRUE(process.wait_for_out("ready", 20s));
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(10s).code, 9);
  expect_nothing_left();
}

TEST_F(Ends, KillingWhoDoesNotListen) {
  Process process(exec({"sh", "-c", "trap '' TERM; echo ready; while :; do sleep 0.1; done"}));
  ASSERT_TRUE(process.wait_for_out("ready", 20s));
  process.signal(SIGTERM);
  EXPECT_EQ(process.wait(20s).code, 128 + SIGKILL);
  expect_nothing_left();
}

TEST_F(Ends, KilledItselfItLeavesNobodyWhoLeftTheGroup) {
  Process process(exec({"--freezer", "signal", "sh", "-c",
                        "setsid sh -c 'echo ready; sleep 1000; exit' & sleep 1000"}));
  ASSERT_TRUE(process.wait_for_out("ready", 20s));
  process.signal(SIGKILL);
  process.wait(10s);
  expect_nothing_left();
}

TEST_F(Ends, KilledItselfItLeavesNothing) {
  for (const std::string freezer : {"auto", "signal"}) {
    Process process(exec(
        {"--freezer", freezer, "sh", "-c", "sleep 1000 & echo ready; kill -STOP $$; sleep 1000"}));
    ASSERT_TRUE(process.wait_for_out("ready", 20s));
    process.signal(SIGKILL);
    process.wait(10s);
    expect_nothing_left();
  }
}

/// A coordinator that takes what is said and does not answer, as one that waits for another SUT.
class SilentCoordinator {
 public:
  SilentCoordinator() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(listener_, any, size), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
    EXPECT_EQ(::getsockname(listener_, any, &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~SilentCoordinator() {
    hang_up();
    ::close(listener_);
  }
  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
  void accept() { connection_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); }
  void hang_up() {
    if (connection_ >= 0) ::close(connection_);
    connection_ = -1;
  }

 private:
  int listener_;
  int connection_ = -1;
  int port_ = 0;
};

class Joining : public Ends {
 protected:
  std::unique_ptr<Process> start(const std::string& freezer) {
    Command command = exec({"--freezer", freezer, THREADS_SUT_PROGRAM, "count", "1"});
    command.environment[0].second = coordinator_.address();
    auto process = std::make_unique<Process>(command);
    coordinator_.accept();
    return process;
  }
  /// Whether the program under tether-exec comes to be stopped by a signal.
  bool is_stopped() {
    for (int i = 0; i < 2000; ++i) {
      for (const pid_t process : processes_with_mark(mark_)) {
        const std::string state = read_text("/proc/" + std::to_string(process) + "/stat");
        if (state.find("(threads_sut) T") != std::string::npos) return true;
      }
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }

  SilentCoordinator coordinator_;
};

// What it computed before it is let in would be charged to nobody.
TEST_F(Joining, HoldsTheProgramUntilItIsLost) {
  const auto process = start("signal");
  EXPECT_TRUE(is_stopped());
  coordinator_.hang_up();
  EXPECT_EQ(process->wait(20s).code, 3);
  expect_nothing_left();
}

TEST_F(Joining, HoldsTheProgramUntilItIsInterrupted) {
  const auto process = start("signal");
  EXPECT_TRUE(is_stopped());
  process->signal(SIGTERM);
  EXPECT_EQ(process->wait(20s).code, 128 + SIGTERM);
  expect_nothing_left();
}

}  // namespace
}  // namespace tether::system_test

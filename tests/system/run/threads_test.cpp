#include "support/faults.h"

#include <algorithm>
#include <csignal>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <tether/link/socket.h>

/// Programs of several threads and processes under tether-exec, with the coordinator and the
/// simulator; and how tether-exec itself ends.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// Both ways to stop a program.
class Threads : public RunTest, public testing::WithParamInterface<std::string> {
 protected:
  /// threads_sut in that mode, as one run; returns the details of its end.
  nlohmann::json fly(const std::string& mode, const std::string& seconds,
                     const std::vector<std::string>& options = {}) {
    const std::string core = std::thread::hardware_concurrency() > 1 ? R"(, "0")" : "";
    const Output ended =
        run(with(flight(mode, {"--quiet"},
                        {{"[\"" + bad_sut_program().string() + "\", \"" + mode + "\"]",
                          "[\"" TETHER_EXEC_PROGRAM "\", \"--freezer\", \"" + GetParam() +
                              "\", \"" THREADS_SUT_PROGRAM "\", \"" + mode + "\", \"" + seconds +
                              "\"" + core + "]"},
                         kWall,
                         {"hang_limit_s = 2", "hang_limit_s = 20"}}),
                 options));
    const std::string printed = read_text(out_ / "sut-uav1.log");
    EXPECT_EQ(ended.code, 0) << ended.err << printed;  // so the audit has passed
    return nlohmann::json::parse(printed.substr(printed.find('{')));
  }
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

// A simulator at a fifth of real time holds the program four fifths of the time. If its threads
// went on computing meanwhile, they would do five times the work in the same ET. Three of at most
// five pairs of flights must agree.
TEST_P(Threads, DoTheSameWorkHoweverSlowTheSimulatorIs) {
  const OffTheFirstCore elsewhere;
  std::vector<double> ratios;
  int equal = 0;
  while (equal < 3 && ratios.size() < 5) {
    const auto unhindered = fly("count", "0.3");
    const auto held = fly("count", "0.3", {"--real-time-factor", "0.2"});
    for (const auto& details : {unhindered, held}) {
      ASSERT_LE(free_to_run_s(details), 1.03 * details["et_s"].get<double>()) << details;
      EXPECT_GE(details["images"].get<int>(), 1);
    }
    ratios.push_back(work_per_s(held) / work_per_s(unhindered));
    equal += std::abs(ratios.back() - 1.0) < 0.05 ? 1 : 0;
  }
  EXPECT_EQ(equal, 3) << testing::PrintToString(ratios);
}

TEST_P(Threads, AreStoppedInAProcessThatLeftTheGroupToo) {
  fly("apart", "0.3", {"--real-time-factor", "0.1"});
}

// The thread that starts a program waits in the kernel until the new process runs it, and that may
// be stopped first.
TEST_P(Threads, StartProgramsMeanwhile) {
  EXPECT_GE(fly("spawn", "1")["started"].get<int>(), 10);
}

INSTANTIATE_TEST_SUITE_P(Freezers, Threads, testing::Values("cgroup", "signal"),
                         [](const auto& freezer) { return freezer.param; });

// ---- Of several UAVs on one board

/// Both on one real board, each with a child that has left the process group, and that fails if it
/// computes while ET stands still; the simulator holds the board nine tenths of the time.
TEST_F(RunTest, ProgramsOfOneBoardAreStoppedTogether) {
  const std::string board = "[[target]]\nname = \"board\"\nclock = \"wall\"\n",
                    other = "[[uav]]\nname = \"uav2\"\nmodel = \"" TETHER_SOURCE_DIR
                            "/data/models/hummingbird/model.sdf\"\nposition_m = [5, 0, 1]\n"
                            "target = \"board\"\n\n";
  const Output ended = run(with(
      flight(
          "apart", {"--quiet"},
          {{"[\"" + bad_sut_program().string() + "\", \"apart\"]",
            "[\"" THREADS_SUT_PROGRAM "\", \"apart\", \"0.3\"]"},
           {"[[uav]]\nname = \"uav1\"\n", board + "[[uav]]\nname = \"uav1\"\ntarget = \"board\"\n"},
           {"[sut]\n", other + "[sut]\n"},
           {"clock = \"cpu\"\n\n", "\n"},
           {"kind = \"time_required\"", "kind = \"time_required\"\nuav = \"uav1\""},
           {"hang_limit_s = 2", "hang_limit_s = 20"}}),
      {"--real-time-factor", "0.1"}));
  EXPECT_EQ(ended.code, 0) << ended.err << read_text(out_ / "exec-board.log");
  EXPECT_EQ(audit_code(out_), 0);
  for (const char* uav : {"uav1", "uav2"})
    EXPECT_EQ(read_text(out_ / ("sut-" + std::string(uav) + ".log")), "{}\n");
  const record::Record record = read_record(out_);
  ASSERT_EQ(record.header.boards.size(), 1u);
  EXPECT_TRUE(record.header.boards[0].is_real);
  std::map<std::string, std::set<ExecTime>> stops;
  for (const auto& [at, order, stop] : record.stops) stops[stop.uav].insert(stop.at);
  const ExecTime common = std::min(*stops.at("uav1").rbegin(), *stops.at("uav2").rbegin());
  for (auto& [uav, times] : stops) times.erase(times.upper_bound(common), times.end());
  EXPECT_GT(stops["uav1"].size(), 2u) << "on a busy machine, each stop takes longer";
  EXPECT_EQ(stops["uav1"], stops["uav2"]);
}

// ---- How it ends, without a coordinator

class Ends : public testing::Test {
 protected:
  Command exec(const std::vector<std::string>& arguments,
               const std::string& address = "127.0.0.1:1") const {
    return with({{TETHER_EXEC_PROGRAM},
                 {{"TETHER_ADDRESS", address},
                  {"TETHER_TOKEN", "token"},
                  {"TETHER_TEST_MARK", mark_},
                  {"TMPDIR", folder_.path().string()}}},
                arguments);
  }
  /// A shell's script under each freezer.
  int code_of(const std::string& freezer, const std::string& script) const {
    return run(exec({"--freezer", freezer, "sh", "-c", script})).code;
  }
  /// Struck by the signal once the script has printed "ready".
  int signalled(int signal, const std::string& script, const std::string& freezer = "auto") const {
    Process process(exec({"--freezer", freezer, "sh", "-c", script}));
    EXPECT_TRUE(process.wait_for_out("ready", 20s));
    process.signal(signal);
    return process.wait(20s).code;
  }
  void TearDown() override {
    EXPECT_TRUE(wait_until_gone(mark_));
    EXPECT_TRUE(wait_until([&] { return std::filesystem::is_empty(folder_.path()); }, 5s));
  }

  TempFolder folder_;
  std::string mark_ = "tether-exec-" + folder_.path().filename().string();
};

// A child that goes on, one that has left the process group, and one that has also lost its parent.
TEST_F(Ends, WithTheCodeOfItsCommandAndAllItsProcesses) {
  for (const std::string freezer : {"auto", "signal"}) {
    EXPECT_EQ(code_of(freezer, "sleep 1000 & exit 5"), 5);
    EXPECT_EQ(code_of(freezer, "kill -SEGV $$"), 128 + SIGSEGV);
    EXPECT_EQ(code_of(freezer,
                      "setsid sleep 1000 & (setsid sh -c 'sleep 1000 & sleep 1000' &) ; sleep 0.2"),
              0);
    EXPECT_TRUE(wait_until_gone(mark_));
  }
}

TEST_F(Ends, WithTwoAfterWrongUse) {
  const Output missing = run(exec({"/nowhere/program"}));
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("/nowhere/program"));
  EXPECT_EQ(run(exec({"/etc/passwd"})).code, 2);
  EXPECT_EQ(run(exec({"true"}, "")).code, 2);
}

TEST_F(Ends, PassingOnASignalAndKillingACommandThatIgnoresIt) {
  const std::string loop = "echo ready; while :; do sleep 0.1; done";
  EXPECT_EQ(signalled(SIGTERM, "trap 'exit 9' TERM; " + loop), 9);
  EXPECT_EQ(signalled(SIGTERM, "trap '' TERM; " + loop), 128 + SIGKILL);
}

TEST_F(Ends, KilledItselfItLeavesNothing) {
  const std::string stopped = "sleep 1000 & echo ready; kill -STOP $$; sleep 1000";
  for (const std::string freezer : {"auto", "signal"}) signalled(SIGKILL, stopped, freezer);
  signalled(SIGKILL, "setsid sh -c 'echo ready; sleep 1000; exit' & sleep 1000", "signal");
}

// What it computed before it is let in would be charged to nobody.
TEST_F(Ends, HavingHeldTheProgramUntilTheCoordinatorIsLost) {
  // Takes connections, and replies to nothing, as one that waits for another SUT.
  auto coordinator = link::listen_on_tcp({"127.0.0.1", 0}).value();
  Process process(exec({"--freezer", "signal", THREADS_SUT_PROGRAM, "count", "1"},
                       link::to_string(link::local_address(coordinator.get()))));
  EXPECT_TRUE(wait_until([&] {
    for (const pid_t pid : processes_with_mark(mark_)) {
      const std::string state = read_text("/proc/" + std::to_string(pid) + "/stat");
      if (state.find("(threads_sut) T") != std::string::npos) return true;
    }
    return false;
  }));
  coordinator = {};
  EXPECT_EQ(process.wait(20s).code, 3);
}

}  // namespace
}  // namespace tether::system_test

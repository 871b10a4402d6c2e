#include "support/board.h"

#include "support/trials.h"

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Runs whose SUT is on a board that SSH reaches: good ones, and every way in which they may fail.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::AnyOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string mark_of_test() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::string(test->name()) + std::to_string(getpid());
}

class OnABoard : public testing::Test {
 protected:
  OnABoard() { board_.install("bad_sut", bad_sut_program()); }

  /// Both sides: the host's processes carry the mark, and so do the board's sessions.
  void expect_nothing_left() const {
    EXPECT_TRUE(wait_until_gone(mark_, 20s));
    EXPECT_THAT(entries(board_.temporary_folder()), IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(board_.folder() / "lock"));
  }
  static std::vector<std::string> entries(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      names.push_back(entry.path().filename());
    return names;
  }

  Command tether_run(const std::filesystem::path& scenario, const std::string& out,
                     const std::vector<std::string>& options = {}) const {
    return tether_to(board_.address(), scenario, out, options);
  }
  Command tether_to(const std::string& address, const std::filesystem::path& scenario,
                    const std::string& out, const std::vector<std::string>& options = {}) const {
    Command command = tether({"run", scenario, "--target", address, "--out", folder_ / out}, mark_);
    command.arguments.insert(command.arguments.end(), options.begin(), options.end());
    for (const auto& variable : board_.environment()) command.environment.push_back(variable);
    return command;
  }
  /// Of the SUT in its mode; the program is one of the board's PATH.
  std::filesystem::path scenario(const std::string& mode,
                                 const std::vector<Substitution>& more = {}) const {
    std::vector<Substitution> all{{bad_sut_program().string(), "bad_sut"}};
    all.insert(all.end(), more.begin(), more.end());
    return write_hover_scenario(folder_.path(), mode, all);
  }

  /// A run that fails as it should: one line that says these things, exit code 3, a whole result.
  nlohmann::json expect_failure(const Command& command, const std::string& out,
                                const std::vector<std::string>& reason) const {
    const Output output = run(command);
    EXPECT_EQ(output.code, 3) << output.err;
    EXPECT_FALSE(output.timed_out);
    const auto result = read_result(folder_ / out);
    EXPECT_EQ(result["outcome"], "failed");
    const std::string text = result["reason"];
    for (const std::string& part : reason) EXPECT_THAT(text, HasSubstr(part));
    EXPECT_THAT(text, Not(HasSubstr("\n")));
    EXPECT_THAT(output.err, HasSubstr("tether: " + text));
    return result;
  }

  /// A run at real time whose SUT flies on and on, so many interactions old.
  std::unique_ptr<Process> start_long_run(const std::string& mode = "fly_on",
                                          std::size_t interactions = 100) {
    auto process = std::make_unique<Process>(
        tether_run(scenario(mode, {{"time_limit_s = 5", "time_limit_s = 600"},
                                   {"hang_limit_s = 2", "hang_limit_s = 30"}}),
                   "out", {"--real-time-factor", "1"}));
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (recorded_so_far() < interactions) {
      if (process->has_ended() || std::chrono::steady_clock::now() > deadline) {
        ADD_FAILURE() << process->err();
        break;
      }
      std::this_thread::sleep_for(50ms);
    }
    return process;
  }
  std::size_t recorded_so_far() const {
    try {
      return read_record(folder_ / "out").interactions.size();
    } catch (const std::exception&) {
      return 0;
    }
  }

  /// The lock names it.
  pid_t keeper() const { return std::stoi(read_text(board_.folder() / "lock")); }
  /// That of the run's ssh on the host.
  std::filesystem::path connection_folder() const {
    const std::string option = "ControlPath=";
    for (const pid_t pid : processes_with_mark(mark_)) {
      const std::string line = read_text("/proc/" + std::to_string(pid) + "/cmdline");
      const auto at = line.find(option);
      if (at == std::string::npos) continue;
      return std::filesystem::path(line.c_str() + at + option.size()).parent_path();
    }
    throw std::runtime_error("no ssh of this run");
  }

  const std::string mark_ = mark_of_test();
  TempFolder folder_;
  SshBoard board_{mark_};
};

// ---- What goes well

TEST_F(OnABoard, ASutFliesAndItsLogComesBack) {
  const Output output = run(tether_run(scenario("good"), "out"));
  EXPECT_EQ(output.code, 0) << output.err;
  const auto result = read_result(folder_ / "out");
  EXPECT_EQ(result["outcome"], "goal_reached");
  EXPECT_EQ(result["clock"], "wall");
  EXPECT_THAT(read_text(folder_ / "out/sut-uav1.log"), HasSubstr("joined"));
  EXPECT_EQ(run(tether({"audit", folder_ / "out/record.mcap"})).code, 0);
  expect_nothing_left();
}

TEST_F(OnABoard, ItsReadingsAreInRecordAndResult) {
  EXPECT_EQ(run(tether_run(scenario("good"), "out")).code, 0);
  const auto target = read_result(folder_ / "out")["this_run"]["target"];
  EXPECT_EQ(target["address"], board_.address());
  EXPECT_TRUE(target["before"].contains("load_average"));
  EXPECT_TRUE(target["after"].contains("load_average"));
  const record::Record record = read_record(folder_ / "out");
  ASSERT_TRUE(record.header.target);
  EXPECT_TRUE(record.header.target->before.contains("uptime_s"));
  EXPECT_TRUE(record.footer->target_after.contains("uptime_s"));
}

TEST_F(OnABoard, AThrottledOneIsNamedInTheVerdict) {
  board_.install_text("vcgencmd", "#!/bin/sh\necho throttled=0x50005\n");
  const Output output = run(tether_run(scenario("good"), "out"));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(read_result(folder_ / "out")["this_run"]["target"]["after"]["throttled"], "0x50005");
}

TEST_F(OnABoard, AProgramThatTheHostLacksIsFoundThere) {
  // By its path there; and a build's, of which the last part is in the PATH there.
  std::filesystem::create_directory(board_.folder() / "opt");
  std::filesystem::create_symlink(bad_sut_program(), board_.folder() / "opt/onboard");
  board_.install("my_sut", bad_sut_program());
  for (const std::string& program :
       {(board_.folder() / "opt/onboard").string(), std::string("./build/my_sut")}) {
    const auto file =
        write_hover_scenario(folder_.path(), "good", {{bad_sut_program().string(), program}});
    const Output output = run(tether_run(file, "out"));
    EXPECT_EQ(output.code, 0) << program << ": " << output.err;
  }
  expect_nothing_left();
}

TEST_F(OnABoard, TetherSutFaces) {
  board_.install("tether-sut", sut_program());
  const Output output = run(tether_run(
      write_face_scenario(folder_.path(), {{"time_limit_s = 20", "time_limit_s = 60"}}), "out"));
  EXPECT_THAT(output.code, AnyOf(0, 1)) << output.err;
  EXPECT_EQ(read_result(folder_ / "out")["end"], "finished");
  expect_nothing_left();
}

TEST_F(OnABoard, FilesGoThereAndComeBack) {
  board_.install_text(
      "copier",
      "#!/bin/sh\ncp \"$3\" \"$TETHER_OUT/copy.txt\"; mkdir \"$TETHER_OUT/sub dir\"\n"
      "echo two >\"$TETHER_OUT/sub dir/b\"; exec bad_sut \"$1\"\n");
  write_text(folder_ / "plan.txt", "a plan\nof two lines");
  const auto file = write_hover_scenario(
      folder_.path(), "good",
      {{bad_sut_program().string(), "copier"},
       {"[[condition]]", "[sut.files]\nplan = \"plan.txt\"\n\n[[condition]]"}});
  const Output output = run(tether_run(file, "out"));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_EQ(read_text(folder_ / "out/copy.txt"), "a plan\nof two lines");
  EXPECT_EQ(read_text(folder_ / "out/sub dir/b"), "two\n");
  expect_nothing_left();
}

TEST_F(OnABoard, ATunnelTakesTheLinkThroughSsh) {
  board_.install_text("teller", "#!/bin/sh\necho \"at $TETHER_ADDRESS\"; exec bad_sut \"$@\"\n");
  const auto file =
      write_hover_scenario(folder_.path(), "good", {{bad_sut_program().string(), "teller"}});
  // An address that the board could not reach, had it to.
  const Output output = run(tether_run(file, "out", {"--tunnel"}));
  EXPECT_EQ(output.code, 0) << output.err;
  EXPECT_THAT(read_text(folder_ / "out/sut-uav1.log"), HasSubstr("at 127.0.0.1:"));
  expect_nothing_left();
}

TEST_F(OnABoard, TheTokenIsInNoListOfProcesses) {
  const auto process = start_long_run();
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string line = read_text(entry.path() / "cmdline");
    EXPECT_THAT(line, Not(HasSubstr("TETHER_TOKEN")));
  }
  process->signal(SIGINT);
  EXPECT_EQ(process->wait(20s).code, 3);
  expect_nothing_left();
}

// ---- What keeps a run from beginning

TEST_F(OnABoard, AMissingProgramIsNamed) {
  expect_failure(tether_run(write_hover_scenario(folder_.path(), "good",
                                                 {{bad_sut_program().string(), "no_such_sut"}}),
                            "out"),
                 "out", {"\"uav1\"", "\"no_such_sut\""});
  expect_nothing_left();
}

TEST_F(OnABoard, AMissingSupervisorOrLauncherIsNamed) {
  const auto file = scenario(
      "good", {{"[sut]", "[sut]\nconcurrent = true"}, {"clock = \"cpu\"", "clock = \"wall\""}});
  expect_failure(tether_run(file, "out"), "out", {"\"tether-exec\"", "tether-sut"});
  // With it the target's launcher comes after it.
  board_.install_text("tether-exec", "#!/bin/sh\nexec \"$@\"\n");
  write_text(folder_ / "board.toml",
             "name = \"b\"\nclock = \"wall\"\nlauncher = [\"no-such\"]\naddress = \"" +
                 board_.address() + "\"\n");
  expect_failure(tether_to(folder_ / "board.toml", file, "out"), "out", {"\"no-such\""});
  expect_nothing_left();
}

TEST_F(OnABoard, AProgramOfAnotherMachineIsNamed) {
  // An ELF header of a machine that nobody has.
  board_.install_text("bad_sut2", std::string("\x7f"
                                              "ELF\x02\x01\x01\0\0\0\0\0\0\0\0\0\x02\0\xf7\0",
                                              20) +
                                      std::string(100, '\0'));
  expect_failure(tether_run(write_hover_scenario(folder_.path(), "good",
                                                 {{bad_sut_program().string(), "bad_sut2"}}),
                            "out"),
                 "out", {"bad_sut2"});
  expect_nothing_left();
}

TEST_F(OnABoard, ASutOfAnotherVersionIsNamed) {
  const auto result =
      expect_failure(tether_run(scenario("old_version"), "out"), "out", {"\"uav1\""});
  EXPECT_EQ(result["end"], "setup_failed");
  expect_nothing_left();
}

TEST_F(OnABoard, AClosedPortIsAReason) {
  expect_failure(tether_to("ssh://127.0.0.1:1", scenario("good"), "out"), "out",
                 {"ssh://127.0.0.1:1", "Connection refused"});
  EXPECT_TRUE(wait_until_gone(mark_));
}

TEST_F(OnABoard, ARefusedKeyIsAReason) {
  write_text(board_.folder() / "authorized_keys", "");
  expect_failure(tether_run(scenario("good"), "out"), "out", {"Permission denied", "ssh-copy-id"});
}

TEST_F(OnABoard, AnUnknownHostKeyIsAReason) {
  write_text(board_.folder() / "known_hosts", "");
  expect_failure(tether_run(scenario("good"), "out"), "out", {"Host key verification failed"});
}

TEST_F(OnABoard, ASecondRunAtOnceIsRefusedAndNamesTheFirst) {
  const auto first = start_long_run();
  Command second = tether_run(scenario("good"), "second");
  expect_failure(second, "second", {std::to_string(first->pid())});
  EXPECT_FALSE(first->has_ended());
  first->signal(SIGINT);
  EXPECT_EQ(first->wait(20s).code, 3);
  expect_nothing_left();
}

TEST_F(OnABoard, TheLockOfADeadRunDoesNotCount) {
  write_text(board_.folder() / "lock", "1 1 another-boot\nsomebody@host, since long ago\n");
  EXPECT_EQ(run(tether_run(scenario("good"), "out")).code, 0);
  expect_nothing_left();
}

TEST_F(OnABoard, AFirewallIsTold) {
  board_.install_text(
      "blocked",
      "#!/bin/sh\necho \"blocked: cannot connect to $TETHER_ADDRESS: timed out\"\nexit 3\n");
  expect_failure(tether_run(write_hover_scenario(folder_.path(), "good",
                                                 {{bad_sut_program().string(), "blocked"}}),
                            "out"),
                 "out", {"--tunnel"});
}

// ---- What ends a run

TEST_F(OnABoard, ALostConnectionEndsTheRun) {
  const auto process = start_long_run();
  board_.cut_connections();
  const Output output = process->wait(30s);
  EXPECT_EQ(output.code, 3);
  const auto result = read_result(folder_ / "out");
  EXPECT_EQ(result["end"], "sut_lost");
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr(board_.address()));
  EXPECT_TRUE(read_record(folder_ / "out").footer);
  expect_nothing_left();
}

TEST_F(OnABoard, ASutThatCrashesIsNamedWithItsSignal) {
  const auto result =
      expect_failure(tether_run(scenario("crash"), "out"), "out", {"\"uav1\"", "signal 11"});
  EXPECT_EQ(result["end"], "sut_lost");
  expect_nothing_left();
}

TEST_F(OnABoard, ASutThatHangsIsNamed) {
  for (const std::string mode : {"stop", "idle"}) {  // halted; waiting for what never comes
    const auto result = expect_failure(tether_run(scenario(mode), mode), mode, {"\"uav1\""});
    EXPECT_EQ(result["end"], "sut_hung") << mode;
    expect_nothing_left();
  }
}

TEST_F(OnABoard, AStubbornSutAndAChildOfItsOwnGoToo) {
  board_.install_text("nest", "#!/bin/sh\nsetsid sleep 1000 &\nexec bad_sut \"$@\"\n");
  const auto file = write_hover_scenario(folder_.path(), "stubborn",
                                         {{bad_sut_program().string(), "nest"},
                                          {"hang_limit_s = 2", "hang_limit_s = 60"},
                                          {"time_limit_s = 5", "time_limit_s = 600"}});
  Process process(tether_run(file, "out", {"--real-time-factor", "1"}));
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (recorded_so_far() < 300 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(50ms);
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(20s).code, 3);
  expect_nothing_left();
}

TEST_F(OnABoard, CtrlCEndsBothSides) {
  const auto process = start_long_run();
  process->signal(SIGINT);
  const Output output = process->wait(20s);
  EXPECT_EQ(output.code, 3);
  EXPECT_EQ(read_result(folder_ / "out")["end"], "interrupted");
  expect_nothing_left();
}

TEST_F(OnABoard, AKeeperThatEndsIsNotTheSutsFault) {
  for (const int signal : {SIGTERM, SIGKILL}) {
    const auto process = start_long_run();
    kill(keeper(), signal);
    const Output output = process->wait(30s);
    EXPECT_EQ(output.code, 3);
    EXPECT_THAT(output.err, AllOf(HasSubstr(board_.address()), Not(HasSubstr("signal"))));
    EXPECT_TRUE(wait_until_gone(mark_, 30s));
    EXPECT_THAT(entries(board_.temporary_folder()), IsEmpty());
    std::filesystem::remove_all(folder_ / "out");
  }
}

TEST_F(OnABoard, AHostThatIsKilledLeavesNothingThere) {
  const auto process = start_long_run();
  const auto on_the_host = connection_folder();
  process->signal(SIGKILL);
  EXPECT_EQ(process->wait(10s).code, 128 + SIGKILL);
  expect_nothing_left();
  // Here the connection's own folder, without a word of what was sent through it.
  EXPECT_THAT(entries(on_the_host),
              Each(AnyOf("socket", "master.out", "master.err", "keeper.out", "keeper.err")));
  std::filesystem::remove_all(on_the_host);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/result.json"));
}

TEST_F(OnABoard, AHostThatFallsSilentIsTakenForGone) {
  const auto process = start_long_run();
  const auto host_and_sessions = processes_with_mark(mark_).size();
  EXPECT_GT(host_and_sessions, 2u);
  // No byte comes any more, and the connection stands.
  process->signal(SIGSTOP);
  const auto is_free = [this] {
    return !std::filesystem::exists(board_.folder() / "lock") &&
           std::filesystem::is_empty(board_.temporary_folder());
  };
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (!is_free() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(is_free());
  process->signal(SIGCONT);
  EXPECT_EQ(process->wait(20s).code, 3);
  expect_nothing_left();
}

// ---- tether target check

TEST_F(OnABoard, CheckShowsOneScreen) {
  Command command = tether({"target", "check", board_.address()}, mark_);
  for (const auto& variable : board_.environment()) command.environment.push_back(variable);
  const Output output = run(command);
  EXPECT_THAT(output.code, AnyOf(0, 1)) << output.err;
  const auto lines = std::ranges::count(output.out, '\n');
  EXPECT_GT(lines, 8);
  EXPECT_LT(lines, 30);
}

TEST_F(OnABoard, CheckFindsAThrottledBoard) {
  board_.install_text("vcgencmd", "#!/bin/sh\necho throttled=0x50005\n");
  Command command = tether({"target", "check", board_.address(), "--json"}, mark_);
  for (const auto& variable : board_.environment()) command.environment.push_back(variable);
  const Output output = run(command);
  EXPECT_EQ(output.code, 1) << output.err;
  const auto json = nlohmann::json::parse(output.out);
  EXPECT_FALSE(json["fine"]);
  EXPECT_EQ(json["readings"]["throttled"], "0x50005");
}

TEST_F(OnABoard, CheckOfOneThatIsNotThereIsASetUpFailure) {
  const Output output = run(tether({"target", "check", "ssh://127.0.0.1:1"}));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("ssh://127.0.0.1:1"));
}

TEST(TargetCheck, OfThisMachineNeedsNoSsh) {
  const Output output = run(tether({"target", "check"}));
  EXPECT_THAT(output.code, AnyOf(0, 1)) << output.err;
  EXPECT_NE(output.out, "");
}

TEST(TargetCheck, RefusesWhatIsNoAddress) {
  EXPECT_EQ(run(tether({"target", "check", "board"})).code, 2);
}

}  // namespace
}  // namespace tether::system_test

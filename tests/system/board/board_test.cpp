#include "support/board.h"

#include "support/faults.h"

#include <algorithm>
#include <csignal>
#include <functional>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

/// Runs whose SUT is on a board that SSH reaches: good ones, and every way in which they may fail.
/// Each step by itself: host/trial/board/test.
namespace tether::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::AnyOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class OnABoard : public RunTest {
 protected:
  OnABoard() { board_.install("bad_sut", bad_sut_program()); }

  static std::vector<std::string> entries(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      names.push_back(entry.path().filename());
    return names;
  }
  /// Both sides: the host's processes carry the mark, and so do the board's sessions.
  void expect_nothing_left() const {
    EXPECT_TRUE(wait_until_gone(mark_, 20s));
    EXPECT_THAT(entries(board_.temporary_folder()), IsEmpty());
    EXPECT_FALSE(std::filesystem::exists(board_.folder() / "lock"));
  }

  /// The SUT in its mode; the program is one of the board's PATH, or another one.
  Command fly(const std::string& mode = "good", const std::string& program = "bad_sut",
              const std::vector<Substitution>& more = {}) const {
    std::vector<Substitution> changes{{bad_sut_program(), program}};
    changes.insert(changes.end(), more.begin(), more.end());
    return on_board(flight(mode, {"--target", board_.address()}, changes));
  }
  Command on_board(const Command& command) const { return with(command, {}, board_.environment()); }
  void expect_good(const Command& command) const {
    const Output output = run(command);
    EXPECT_EQ(output.code, 0) << output.err;
    EXPECT_EQ(result()["outcome"], "goal_reached");
    expect_nothing_left();
  }
  /// A run that fails, for a reason that names these.
  void expect_failure(const Command& command, const Failure& failure) const {
    expect_failed(run(command), failure);
    expect_nothing_left();
  }

  /// A run at real time whose SUT flies on and on, so many interactions old.
  std::unique_ptr<Process> start_long_run(const std::string& mode = "fly_on",
                                          const std::string& program = "bad_sut",
                                          std::size_t interactions = 100) {
    auto process =
        std::make_unique<Process>(with(fly(mode, program, kEndless), {"--real-time-factor", "1"}));
    wait_until_recorded(*process, out_, interactions);
    return process;
  }
  void expect_interrupted(Process& process) {
    expect_failed(process.wait(20s), {"interrupted", {}});
    expect_nothing_left();
  }

  const SshBoard board_{mark_};
};

// ---- What goes well

TEST_F(OnABoard, ASutFliesAndItsLogAndTheBoardsReadingsComeBack) {
  expect_good(fly());
  EXPECT_EQ(result()["clock"], "wall");
  EXPECT_THAT(read_text(out_ / "sut-uav1.log"), HasSubstr("joined"));
  EXPECT_EQ(audit_code(out_), 0);
  const auto target = result()["this_run"]["target"];
  EXPECT_EQ(target["address"], board_.address());
  EXPECT_TRUE(target["before"].contains("load_average"));
  EXPECT_TRUE(target["after"].contains("load_average"));
  const record::Record record = read_record(out_);
  ASSERT_TRUE(record.header.target);
  EXPECT_TRUE(record.header.target->before.contains("uptime_s"));
  EXPECT_TRUE(record.footer->target_after.contains("uptime_s"));
}

// By its path there; and a build's, of which the last part is in the PATH there. The lock of a dead
// run does not count.
TEST_F(OnABoard, AProgramThatTheHostLacksIsFoundThere) {
  std::filesystem::create_directory(board_.folder() / "opt");
  std::filesystem::create_symlink(bad_sut_program(), board_.folder() / "opt/onboard");
  board_.install("my_sut", bad_sut_program());
  write_text(board_.folder() / "lock", "1 1 another-boot\nsomebody@host, since long ago\n");
  expect_good(fly("good", board_.folder() / "opt/onboard"));
  expect_good(fly("good", "./build/my_sut"));
}

// The tunnel's address is one that the board could not reach by itself.
TEST_F(OnABoard, FilesGoThereAndComeBackAndATunnelTakesTheLink) {
  board_.install_text(
      "copier",
      "#!/bin/sh\ncp \"$3\" \"$TETHER_OUT/copy.txt\"; mkdir \"$TETHER_OUT/sub dir\"\n"
      "echo \"$TETHER_ADDRESS\" >\"$TETHER_OUT/sub dir/b\"; exec bad_sut \"$1\"\n");
  write_text(folder_ / "plan.txt", "a plan\nof two lines");
  expect_good(with(fly("good", "copier",
                       {{"[[condition]]", "[sut.files]\nplan = \"plan.txt\"\n\n[[condition]]"}}),
                   {"--tunnel"}));
  EXPECT_EQ(read_text(out_ / "copy.txt"), "a plan\nof two lines");
  EXPECT_THAT(read_text(out_ / "sub dir/b"), HasSubstr("127.0.0.1:"));
}

// A board with the programs of two UAVs, a counted program, and one by CPU time, on one barrier,
// each with its own clock.
TEST_F(OnABoard, AMixedFleetFliesWithTheClockAndTheReadingsOfEach) {
  board_.install("tether-exec", TETHER_EXEC_PROGRAM);
  write_text(folder_ / "pi.toml", "name = \"pi\"\naddress = \"" + board_.address() + "\"\n");
  const std::string targets =
      "[[target]]\nname = \"pi\"\nfile = \"pi.toml\"\n"
      "[[target]]\nname = \"counted\"\nfile = \"" TETHER_SOURCE_DIR
      "/data/profiles/targets/counted_host.toml\"\n"
      "[[target]]\nname = \"virtual\"\nclock = \"cpu\"\ncpu_factor = 3\n";
  std::string uavs;
  int x_m = 5;
  for (const char* target : {"counted", "virtual", "pi"}) {
    uavs += "[[uav]]\nname = \"" + std::string(target) +
            "1\"\nmodel = \"" TETHER_SOURCE_DIR
            "/data/models/hummingbird/model.sdf\"\nposition_m = [" +
            std::to_string(x_m) + ", 0, 1]\ntarget = \"" + target + "\"\n[uav.sut]\ncommand = [\"" +
            (target == std::string("pi") ? "bad_sut" : bad_sut_program().string()) +
            "\", \"good\"]\n\n";
    x_m += 5;
  }
  expect_good(on_board(flight(
      "good", {},
      {{bad_sut_program(), "bad_sut"},
       {"[[uav]]\nname = \"uav1\"\n", targets + "[[uav]]\nname = \"uav1\"\ntarget = \"pi\"\n"},
       {"[sut]\n", uavs + "[sut]\n"},
       {"clock = \"cpu\"\n\n", "\n"},
       // The wall clock goes on while other tests have the machine's cores.
       {"time_limit_s = 5", "time_limit_s = 60"},
       {"kind = \"time_required\"", "kind = \"time_required\"\nuav = \"uav1\""}})));
  const auto suts = result()["suts"];
  ASSERT_EQ(suts.size(), 4u);
  EXPECT_EQ(suts[0]["clock"], "wall");
  EXPECT_EQ(suts[1]["clock"], "counted");
  EXPECT_EQ(suts[2]["clock"], "cpu");
  EXPECT_EQ(suts[3]["clock"], "wall");
  for (const char* log : {"sut-uav1.log", "sut-pi1.log"})
    EXPECT_THAT(read_text(out_ / log), HasSubstr("joined"));
  const record::Record record = read_record(out_);
  EXPECT_EQ(record.header.suts[0].board, "pi");
  EXPECT_EQ(record.header.suts[3].board, "pi");
  EXPECT_EQ(result()["this_run"]["target"]["name"], "pi");
  EXPECT_EQ(result()["this_run"]["target"]["address"], board_.address());
  EXPECT_TRUE(result()["this_run"]["more_targets"][0]["before"].contains("load_average"));
  EXPECT_EQ(audit_code(out_), 0);
}

// By its own clock, all of it stopped while images are sent there.
TEST_F(OnABoard, AProgramAsItIsReadsItsCameraThere) {
  board_.install("tether-exec", TETHER_EXEC_PROGRAM);
  board_.install("camera_program", CAMERA_PROGRAM);
  const auto file = folder_ / "as_is.toml";
  write_text(
      file,
      "name = \"as_is\"\nworld = \"yard\"\ntime_limit_s = 20\n[[uav]]\nname = \"uav1\"\nmodel = "
      "\"hummingbird\"\nposition_m = [0.0, 0.0, 0.1]\nprofile = \"paper_streaming\"\n"
      "[sut]\ncommand = [\"camera_program\", \"late\"]\nas_is = true\nall_processes = true\n"
      "[[condition]]\nname = \"c\"\npolicy = \"conservative_barrier\"\nclock = \"cpu\"\n");
  expect_good(on_board(
      tether({"run", file, "--quiet", "--target", board_.address(), "--out", out_}, mark_)));
  EXPECT_EQ(result()["clock"], "wall");
  std::istringstream lines(read_text(out_ / "sut-uav1.log"));
  int images = 0, bright = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string how;
    long number = 0, age_us = 0, waited_us = 0;
    bool is_bright = false;
    if (!(words >> how >> number >> age_us >> waited_us >> is_bright)) continue;
    ++images, bright += is_bright;
    EXPECT_GE(age_us, 37'400) << how << ": its delay";
  }
  EXPECT_EQ(images, 10);
  EXPECT_EQ(bright, 10);
  EXPECT_EQ(audit_code(out_), 0);
}

// ---- What keeps a run from beginning

TEST_F(OnABoard, AMissingProgramSupervisorOrLauncherIsNamed) {
  expect_failure(fly("good", "no_such_sut"), {"setup_failed", {"\"uav1\"", "\"no_such_sut\""}});
  const std::vector<Substitution> concurrent{{"[sut]", "[sut]\nconcurrent = true"}, kWall};
  expect_failure(fly("good", "bad_sut", concurrent), {"setup_failed", {"\"tether-exec\""}});
  // With it the target's launcher comes after it.
  board_.install_text("tether-exec", "#!/bin/sh\nexec \"$@\"\n");
  write_text(folder_ / "board.toml",
             "name = \"b\"\nclock = \"wall\"\nlauncher = [\"no-such\"]\naddress = \"" +
                 board_.address() + "\"\n");
  Command command = fly("good", "bad_sut", concurrent);
  std::ranges::replace(command.arguments, board_.address(), (folder_ / "board.toml").string());
  expect_failure(command, {"setup_failed", {"\"no-such\""}});
}

TEST_F(OnABoard, AProgramOfAnotherMachineIsNamed) {
  // An ELF header of a machine that nobody has.
  board_.install_text("bad_sut2", std::string("\x7f"
                                              "ELF\x02\x01\x01\0\0\0\0\0\0\0\0\0\x02\0\xf7\0",
                                              20) +
                                      std::string(100, '\0'));
  expect_failure(fly("good", "bad_sut2"), {"setup_failed", {"bad_sut2"}});
}

TEST_F(OnABoard, AClosedPortARefusedAndAnUnknownKeyAreReasons) {
  Command command = fly();
  std::ranges::replace(command.arguments, board_.address(), std::string("ssh://127.0.0.1:1"));
  expect_failure(command, {"setup_failed", {"ssh://127.0.0.1:1", "Connection refused"}});
  write_text(board_.folder() / "authorized_keys", "");
  expect_failure(fly(), {"setup_failed", {"Permission denied", "ssh-copy-id"}});
  write_text(board_.folder() / "known_hosts", "");
  expect_failure(fly(), {"setup_failed", {"Host key verification failed"}});
}

TEST_F(OnABoard, ASecondRunAtOnceIsRefusedAndNamesTheFirst) {
  const auto first = start_long_run();
  Command second = fly();
  std::ranges::replace(second.arguments, out_.string(), (folder_ / "second").string());
  const Output refused = run(second);
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr(std::to_string(first->pid())));
  EXPECT_FALSE(first->has_ended());
  first->signal(SIGINT);
  expect_interrupted(*first);
}

// ---- What ends a run

TEST_F(OnABoard, ALostConnectionEndsTheRun) {
  const auto process = start_long_run();
  board_.cut_connections();
  expect_failed(process->wait(30s), {"sut_lost", {board_.address()}});
  EXPECT_TRUE(read_record(out_).footer);
  expect_nothing_left();
}

TEST_F(OnABoard, ASutThatCrashesOrHangsIsNamed) {
  expect_failure(fly("crash"), {"sut_lost", {"\"uav1\"", "signal 11"}});
  for (const std::string mode : {"stop", "idle"})  // halted; waiting for what never comes
    expect_failure(fly(mode), {"sut_hung", {"\"uav1\""}});
}

TEST_F(OnABoard, CtrlCEndsBothSidesWithAStubbornSutAndItsChild) {
  board_.install_text("nest", "#!/bin/sh\nsetsid sleep 1000 &\nexec bad_sut \"$@\"\n");
  const auto process = start_long_run("stubborn", "nest", 300);
  process->signal(SIGINT);
  expect_interrupted(*process);
}

// The keeper is the shell on the board that holds its lock, which names it.
TEST_F(OnABoard, AKeeperThatEndsIsNotTheSutsFault) {
  for (const int signal : {SIGTERM, SIGKILL}) {
    const auto process = start_long_run();
    kill(std::stoi(read_text(board_.folder() / "lock")), signal);
    const Output output = process->wait(30s);
    EXPECT_EQ(output.code, 3);
    EXPECT_THAT(output.err, AllOf(HasSubstr(board_.address()), Not(HasSubstr("signal"))));
    EXPECT_TRUE(wait_until_gone(mark_, 30s));
    EXPECT_THAT(entries(board_.temporary_folder()), IsEmpty());
    std::filesystem::remove_all(out_);
  }
}

TEST_F(OnABoard, AHostThatIsKilledLeavesNothingThere) {
  const auto process = start_long_run();
  std::filesystem::path connection;  // the folder of the run's ssh on the host
  const std::string option = "ControlPath=";
  for (const pid_t pid : processes_with_mark(mark_)) {
    const std::string line = read_text("/proc/" + std::to_string(pid) + "/cmdline");
    const auto at = line.find(option);
    if (at != std::string::npos)
      connection = std::filesystem::path(line.c_str() + at + option.size()).parent_path();
  }
  process->signal(SIGKILL);
  EXPECT_EQ(process->wait(10s).code, 128 + SIGKILL);
  expect_nothing_left();
  // On the host that folder, with nothing of what was sent through it.
  EXPECT_THAT(entries(connection),
              Each(AnyOf("socket", "master.out", "master.err", "keeper.out", "keeper.err")));
  std::filesystem::remove_all(connection);
  EXPECT_FALSE(std::filesystem::exists(out_ / "result.json"));
}

// No byte comes any more, and the connection stays open.
TEST_F(OnABoard, AHostThatFallsSilentIsTakenForGone) {
  const auto process = start_long_run();
  EXPECT_GT(processes_with_mark(mark_).size(), 2u);
  process->signal(SIGSTOP);
  EXPECT_TRUE(wait_until(
      [this] {
        return !std::filesystem::exists(board_.folder() / "lock") &&
               std::filesystem::is_empty(board_.temporary_folder());
      },
      30s));
  process->signal(SIGCONT);
  EXPECT_EQ(process->wait(20s).code, 3);
  expect_nothing_left();
}

// ---- tether target check

TEST_F(OnABoard, CheckShowsOneScreenAndFindsAThrottledBoard) {
  const Command check = on_board(tether({"target", "check", board_.address()}, mark_));
  const Output output = run(check);
  EXPECT_LE(output.code, 1) << output.err;
  const auto lines = std::ranges::count(output.out, '\n');
  EXPECT_GT(lines, 8);
  EXPECT_LT(lines, 30);

  board_.install_text("vcgencmd", "#!/bin/sh\necho throttled=0x50005\n");
  const Output throttled = run(with(check, {"--json"}));
  EXPECT_EQ(throttled.code, 1) << throttled.err;
  const auto json = nlohmann::json::parse(throttled.out);
  EXPECT_FALSE(json["fine"]);
  EXPECT_EQ(json["readings"]["throttled"], "0x50005");
}

TEST(TargetCheck, OfNoBoardIsASetUpFailureAndOfThisMachineNeedsNoSsh) {
  const Output output = run(tether({"target", "check", "ssh://127.0.0.1:1"}));
  EXPECT_EQ(output.code, 3);
  EXPECT_THAT(output.err, HasSubstr("ssh://127.0.0.1:1"));
  const Output here = run(tether({"target", "check"}));
  EXPECT_LE(here.code, 1) << here.err;
  EXPECT_NE(here.out, "");
}

}  // namespace
}  // namespace tether::system_test

#include "support/trials.h"

#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

/// Programs that know nothing of Tether fly: their clocks are ET, their waits are interactions, and
/// their UDP port is that of the flight controller.
namespace tether::system_test {
namespace {

class AsIs : public testing::Test {
 protected:
  /// Runs a Python program, or the command of a program, with that limit of ST.
  Output fly(const std::string& command, int limit_s = 30) const {
    const auto file = folder_ / "as_is.toml";
    write_text(file,
               "name = \"as_is\"\nworld = \"yard\"\ntime_limit_s = " + std::to_string(limit_s) +
                   "\n[[uav]]\nname = \"uav1\"\nmodel = \"hummingbird\"\n"
                   "position_m = [0.0, 0.0, 0.1]\nflight_controller = \"built-in\"\n"
                   "[sut]\ncommand = [" +
                   command +
                   "]\nas_is = true\n"
                   "[[condition]]\nname = \"host\"\npolicy = \"conservative_barrier\"\n"
                   "clock = \"cpu\"\ncpu_factor = 1.0\n");
    return run(tether({"run", file, "--quiet", "--force", "--out", folder_ / "out"}));
  }
  Output fly_python(const std::string& program, int limit_s = 30) const {
    write_text(folder_ / "program.py", program);
    return fly("\"python3\", \"" + (folder_ / "program.py").string() + "\"", limit_s);
  }
  std::string said() const { return read_text(folder_ / "out" / "sut-uav1.log"); }
  nlohmann::json result() const { return read_result(folder_ / "out"); }

  TempFolder folder_;
};

// Waits of 20 ms by each function; what they take longer is what the program computed.
TEST_F(AsIs, EveryWayToWaitTakesItsTimeByEveryClock) {
  constexpr long kWait_us = 20'000, kMost_us = 23'000;
  const Output output = fly("\"" WAITS_PROGRAM "\"");
  ASSERT_EQ(output.code, 0) << output.err << said();
  std::istringstream lines(said());
  int ways = 0;
  std::string name;
  for (long monotonic_us = 0, real_us = 0; lines >> name >> monotonic_us >> real_us; ++ways) {
    if (name == "woken_beside_computing") continue;
    if (name == "beside_computing") {
      EXPECT_GE(monotonic_us, 40'000);
      EXPECT_LE(monotonic_us, 50'000);
      continue;
    }
    EXPECT_GE(monotonic_us, kWait_us) << name;
    EXPECT_LE(monotonic_us, kMost_us) << name;
    EXPECT_NEAR(static_cast<double>(real_us), static_cast<double>(monotonic_us), 500.0) << name;
  }
  EXPECT_EQ(ways, 21);
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
}

TEST_F(AsIs, WhatTheProgramSawIsItsExecutionTime) {
  const Output output = fly_python(
      "import time\nbegin = time.monotonic()\n"
      "for i in range(50):\n"
      "    time.sleep(0.02)\n"
      "    sum(range(10000))\n"
      "print(time.monotonic() - 1000.0)\n");
  ASSERT_EQ(output.code, 0) << output.err << said();
  // The rest is the end of the interpreter.
  EXPECT_NEAR(std::stod(said()), result()["sync"]["st_at_end_s"].get<double>(), 0.03);
}

TEST_F(AsIs, ThreadsWaitForEachOtherAndForTheRun) {
  const Output output = fly_python(
      "import queue, threading, time\n"
      "q, begin = queue.Queue(), time.monotonic()\n"
      "def work():\n"
      "    for i in range(10):\n"
      "        time.sleep(0.1)\n"
      "        q.put(i)\n"
      "threads = [threading.Thread(target=work) for _ in range(3)]\n"
      "for t in threads: t.start()\n"
      "got = empty = 0\n"
      "while got < 30:\n"
      "    try:\n"
      "        q.get(timeout=0.03)\n"
      "        got += 1\n"
      "    except queue.Empty:\n"
      "        empty += 1\n"
      "for t in threads: t.join()\n"
      "print(empty, time.monotonic() - begin)\n");
  ASSERT_LE(output.code, 3) << output.err << said();
  std::istringstream words(said());
  int empty = 0;
  double took_s = 0.0;
  ASSERT_TRUE(words >> empty >> took_s) << said();
  EXPECT_GE(empty, 28);
  EXPECT_LE(empty, 31);
  EXPECT_NEAR(took_s, 1.0, 0.05);
}

TEST_F(AsIs, TheExitCodeDecides) {
  EXPECT_EQ(fly_python("import time, sys\ntime.sleep(1)\nsys.exit(5)\n").code, 1);
  EXPECT_EQ(result()["suts"][0]["outcome"], "the program ended with exit code 5");
}

TEST_F(AsIs, AProgramThatCrashesIsNamedAndNothingHangs) {
  const Output output =
      fly_python("import os, signal, time\ntime.sleep(1)\nos.kill(os.getpid(), signal.SIGSEGV)\n");
  EXPECT_EQ(output.code, 3);
  EXPECT_NE(output.err.find("signal 11"), std::string::npos) << output.err;
}

TEST_F(AsIs, AProgramThatGoesOnIsEndedAtTheTimeLimit) {
  EXPECT_EQ(fly_python("import time\nwhile True: time.sleep(0.01)\n", 3).code, 1);
  EXPECT_NEAR(result()["sync"]["st_at_end_s"].get<double>(), 3.0, 0.01);
}

TEST_F(AsIs, AForkedChildHasTheMachinesClock) {
  const Output output = fly_python(
      "import subprocess, sys, time\ntime.sleep(0.5)\n"
      "child = 'import time; time.sleep(0.05); print(time.monotonic() > 999, time.time() > 1e9)'\n"
      "print(subprocess.run([sys.executable, '-c', child], capture_output=True, "
      "text=True).stdout)\n"
      "time.sleep(0.5)\n");
  EXPECT_LE(output.code, 3) << output.err << said();
  EXPECT_NE(said().find("True"), std::string::npos) << said();
}

// What a program may do with its own threads, processes, descriptors and errors.
TEST_F(AsIs, UsualThingsOfProgramsGoOnToWork) {
  const Output output = fly_python(
      "import errno, os, socket, subprocess, threading, time\n"
      "def daemon():\n"
      "    while True: time.sleep(0.001)\n"
      "threading.Thread(target=daemon, daemon=True).start()\n"
      "try: subprocess.run(['there-is-no-such-program'])\n"
      "except FileNotFoundError: pass\n"
      "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
      "s.bind(('', 14540))\n"
      "assert s.getsockname()[1] == 14540\n"
      "copy = os.dup(s.fileno())\n"
      "s.setblocking(True)\n"
      "assert len(os.read(copy, 1000)) > 10\n"
      "s.setblocking(False)\n"
      "try:\n"
      "    while True: s.recv(1000)\n"
      "except BlockingIOError: pass\n"
      "before = time.monotonic()\n"
      "subprocess.run(['python3', '-c', 'sum(range(3000000))'])\n"
      "assert 0.02 < time.monotonic() - before < 2.0\n"
      "time.sleep(0.5)\n"
      "print('all went well')\n");
  EXPECT_EQ(output.code, 0) << output.err << said();
  EXPECT_NE(said().find("all went well"), std::string::npos) << said();
}

// The kernel's own timers are not brought to ET, and the user is told.
TEST_F(AsIs, WhatIsNotCoveredIsTold) {
  const Output output = fly_python("import signal, time\nsignal.alarm(100)\ntime.sleep(0.2)\n");
  EXPECT_EQ(output.code, 0) << output.err << said();
  EXPECT_NE(said().find("alarm, which follows the machine's clock"), std::string::npos) << said();
}

// The same program by MAVLink: a fast computer reaches the corners, a slow one does not.
TEST_F(AsIs, AnUnmodifiedCompanionFliesASquareAndASlowOneDoesNot) {
  const auto out = folder_ / "out";
  const auto fly_under = [&](const std::string& condition) {
    return run(tether(
        {"run", "mavlink_square", "--quiet", "--force", "--condition", condition, "--out", out}));
  };
  const Output fast = fly_under("host");
  EXPECT_EQ(fast.code, 0) << fast.err << said();
  EXPECT_EQ(audit_code(out), 0);
  const auto record = read_record(out);
  EXPECT_GT(record.autopilot.size(), 1000U);
  const Output slow = fly_under("target");
  EXPECT_EQ(slow.code, 1) << slow.err << said();
  EXPECT_EQ(audit_code(out), 0);
}

}  // namespace
}  // namespace tether::system_test

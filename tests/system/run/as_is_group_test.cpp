#include "support/trials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

/// All processes of a program that knows nothing of Tether fly: they share one execution time, talk
/// to each other over the loopback, and reach the UAV's devices from any of them.
namespace tether::system_test {
namespace {

using testing::HasSubstr;

class AsIsGroup : public testing::Test {
 protected:
  Output fly(const std::string& script, double factor = 1.0, int limit_s = 20,
             const std::string& clock = "clock = \"cpu\"\n") const {
    write_text(folder_ / "start.sh", "#!/bin/bash\n" + script);
    const auto file = folder_ / "group.toml";
    std::ostringstream text;
    text << "name = \"group\"\nworld = \"yard\"\ntime_limit_s = " << limit_s
         << "\n[[uav]]\nname = \"uav1\"\nmodel = \"hummingbird\"\nposition_m = [0.0, 0.0, 0.1]\n"
            "flight_controller = \""
         << flight_controller_
         << "\"\nprofile = \"paper_streaming\"\n"
            "[sut]\ncommand = [\"/bin/bash\", \""
         << (folder_ / "start.sh").string()
         << "\"]\nas_is = true\nall_processes = true\n"
            "[[condition]]\nname = \"c\"\npolicy = \"conservative_barrier\"\n"
         << clock;
    if (clock.find("cpu") != std::string::npos)
      text << "cpu_factor = " << std::fixed << factor << "\n";
    write_text(file, text.str());
    return run(tether({"run", file, "--quiet", "--force", "--out", folder_ / "out"}));
  }
  /// Of a program that does nothing with its UAV, whose flight then fails.
  void expect_exit_0(const Output& output) const {
    EXPECT_THAT(read_result(folder_ / "out")["suts"][0]["outcome"].get<std::string>(),
                HasSubstr("exit code 0"))
        << output.err << said();
    EXPECT_EQ(audit_code(folder_ / "out"), 0);
  }
  /// For programs in Python on the client library.
  static std::string with_library() {
    const auto prefix = std::filesystem::path(TETHER_EXEC_PROGRAM).parent_path().parent_path();
    return "export PYTHONPATH=" TETHER_SOURCE_DIR "/python TETHER_CLIENT_LIBRARY=" +
           (prefix / "lib" / "libtether-client.so.1").string() + "\n";
  }
  std::string said() const { return read_text(folder_ / "out" / "sut-uav1.log"); }

  TempFolder folder_;
  std::string flight_controller_ = "built-in";
};

// Each in a process of its own: those that wait and those that compute see one clock. Each writes a
// line at once, because they share the log.
TEST_F(AsIsGroup, ProcessesHaveOneClockAndTheirWaitsTakeNoRealTime) {
  write_text(folder_ / "one.py",
             "import sys, time\n"
             "for i in range(int(sys.argv[2])):\n"
             "    time.sleep(float(sys.argv[1]))\n"
             "    sys.stdout.write(f'{sys.argv[1]} {time.monotonic()}\\n')\n"
             "    sys.stdout.flush()\n");
  const std::string one = "python3 " + (folder_ / "one.py").string();
  const Output output = fly(one + " 0.5 4 &\n" + one + " 0.2 10\nsleep 3\nwait\nexit 0\n");
  expect_exit_0(output);
  std::istringstream lines(said());
  constexpr double kHandOver_s = 0.01;  // between a look at the clock and its line, another may run
  double last_s = 0.0;
  int count = 0;
  for (double period_s = 0.0, at_s = 0.0; lines >> period_s >> at_s; ++count) {
    EXPECT_GE(at_s, last_s - kHandOver_s) << said();
    last_s = at_s;
  }
  EXPECT_EQ(count, 14) << said();
  EXPECT_NEAR(read_result(folder_ / "out")["sync"]["st_at_end_s"].get<double>(), 5.2, 0.4);
  EXPECT_TRUE(
      read_result(folder_ / "out")["suts"][0]["details"]["computed_s"].contains("python3 one.py"))
      << read_result(folder_ / "out")["suts"][0];
}

// What the other process computes is what a message takes there and back, on any machine under any
// load; the rest is the interpreters'.
TEST_F(AsIsGroup, AMessageOverTheLoopbackTakesWhatProcessesCompute) {
  write_text(folder_ / "server.py",
             "import socket, time\n"
             "server = socket.create_server(('127.0.0.1', 0))\n"
             "print(server.getsockname()[1], file=open('port', 'w'), flush=True)\n"
             "peer = server.accept()[0]\n"
             "while data := peer.recv(100):\n"
             "    begin = time.thread_time()\n"
             "    while time.thread_time() - begin < 0.01: pass\n"
             "    for byte in data: peer.send(bytes([byte]))\n");
  write_text(folder_ / "client.py",
             "import socket, time\n"
             "peer = socket.create_connection(('127.0.0.1', int(open('port').read())))\n"
             "peer.settimeout(1.0)\n"
             "took = []\n"
             "for i in range(30):\n"
             "    time.sleep(0.05)\n"
             "    begin = time.monotonic()\n"
             "    peer.send(b'ab')\n"
             "    peer.recv(1), peer.recv(1)\n"
             "    took.append(time.monotonic() - begin)\n"
             "took.sort()\n"
             "print(took[0], took[15])\n"
             "before = time.monotonic()\n"
             "try: peer.recv(1)\n"
             "except TimeoutError: print(time.monotonic() - before)\n");
  const std::string script = "cd " + folder_.path().string() +
                             "\npython3 server.py &\nwhile [ ! -s port ]; do sleep 0.01; done\n"
                             "python3 client.py\nexit 0\n";
  for (const double factor : {1.0, 6.0}) {
    const Output output = fly(script, factor);
    expect_exit_0(output);
    std::istringstream lines(said());
    double least_s = 0.0, median_s = 0.0, timeout_s = 0.0;
    ASSERT_TRUE(lines >> least_s >> median_s >> timeout_s) << said();
    EXPECT_GE(least_s, 0.01 * factor);
    EXPECT_LE(median_s, 0.0115 * factor);
    EXPECT_GE(timeout_s, 1.0);
    EXPECT_LE(timeout_s, 1.0 + 0.005 * factor);
    std::filesystem::remove(folder_ / "port");
  }
}

// One process has the link to the flight controller, another one the camera, and a forked one
// waits.
TEST_F(AsIsGroup, EachProcessHasTheDevicesOfTheUav) {
  write_text(folder_ / "link.py",
             "import os, socket, sys, time\n"
             "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
             "s.bind(('', 14540))\n"
             "s.sendto(b'x', s.recvfrom(1000)[1])\n"
             "child = os.fork()\n"
             "if child == 0:\n"
             "    begin = time.monotonic()\n"
             "    time.sleep(0.3)\n"
             "    os.write(1, f'child {time.monotonic() - begin}\\n'.encode())\n"
             "    os._exit(0)\n"
             "s.settimeout(2.0)\n"
             "n, begin = 0, time.monotonic()\n"
             "while time.monotonic() - begin < 0.4: n += len(s.recv(1000)) > 0\n"
             "os.write(1, f'messages {n}\\n'.encode())\n"
             "os.waitpid(child, 0)\n");
  const Output output = fly("python3 " + (folder_ / "link.py").string() + " &\n" + "sleep 0.6\n" +
                            std::string(CAMERA_PROGRAM) + "\nwait $!\n");
  EXPECT_EQ(output.code, 0) << output.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  std::istringstream lines(said());
  int images = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string what;
    double number = 0.0;
    words >> what >> number;
    if (what == "child") {
      EXPECT_NEAR(number, 0.3, 0.05);
    } else if (what == "messages") {
      EXPECT_GT(number, 20.0);
    } else {
      ++images;
    }
  }
  EXPECT_EQ(images, 10) << said();
}

// The timed waits of each library, in a process that is not the first one.
TEST_F(AsIsGroup, EveryWayToWaitTakesItsTime) {
  const Output output = fly(std::string(WAITS_PROGRAM) + "\nexit 0\n");
  expect_exit_0(output);
  std::istringstream lines(said());
  int ways = 0;
  std::string name;
  for (long monotonic_us = 0, real_us = 0; lines >> name >> monotonic_us >> real_us; ++ways) {
    if (name == "woken_beside_computing" || name == "beside_computing") continue;
    EXPECT_GE(monotonic_us, 20'000) << name;
    EXPECT_LE(monotonic_us, 23'000) << name;
  }
  EXPECT_EQ(ways, 38);
}

// Python hands its lock over only to a thread whose wait for it timed out.
TEST_F(AsIsGroup, ThreadsOfPythonTakeTurnsBesideOneThatComputes) {
  write_text(folder_ / "turns.py",
             "import threading, time\n"
             "def compute():\n"
             "    while True: pass\n"
             "threading.Thread(target=compute, daemon=True).start()\n"
             "begin = time.monotonic()\n"
             "for i in range(20): time.sleep(0.001)\n"
             "print(time.monotonic() - begin, flush=True)\n");
  const Output output = fly("python3 " + (folder_ / "turns.py").string() + "\nexit 0\n");
  expect_exit_0(output);
  EXPECT_LT(std::stod(said()), 0.5) << "20 sleeps of 1 ms, and 20 turns of 5 ms";
}

// With the wall clock, all processes are stopped while the simulation catches up, here for more
// than half of the time, and at each message that one of them sends or gets. None of them sees it.
TEST_F(AsIsGroup, ProgramsThatAreStoppedSeeNoGap) {
  write_text(folder_ / "link.py",
             "import os, socket, time\n"
             "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
             "s.bind(('', 14540))\n"
             "peer, last, back, n = s.recvfrom(1000)[1], 0.0, 0, 0\n"
             "if os.fork() == 0: s = None\n"  // the child only looks at its clock
             "begin = time.monotonic()\n"
             "while last - begin < 0.4:\n"
             "    now = time.monotonic()\n"
             "    back, last = back + (now < last), now\n"
             "    if s: n += len(s.recv(1000)) > 0; s.sendto(b'x', peer); time.sleep(0.001)\n"
             "os.write(1, f'back {back} {n}\\n'.encode())\n");
  const Output output =
      fly("python3 " + (folder_ / "link.py").string() + " &\n" + WAITS_PROGRAM + "\nwait\nexit 0\n",
          1.0, 20, "clock = \"wall\"\nreal_time_factor = 0.4\n");
  EXPECT_EQ(output.code, 0) << output.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  EXPECT_GT(read_result(folder_ / "out")["sync"]["stops"].get<int>(), 50);
  std::istringstream lines(said());
  std::vector<long> waits;
  int processes = 0, messages = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    long first = 0, second = 0;
    if (!(words >> name >> first >> second) || name.ends_with("beside_computing")) continue;
    if (name == "back") {
      EXPECT_EQ(first, 0) << "the clock went back";
      ++processes, messages += static_cast<int>(second);
      continue;
    }
    // The controller's messages go to this process as well, and may end a read.
    EXPECT_GE(first, name == "SO_RCVTIMEO" ? 0 : 20'000) << name;
    waits.push_back(first);
  }
  EXPECT_EQ(processes, 2) << said();
  EXPECT_GT(messages, 0) << said();
  ASSERT_EQ(waits.size(), 36U) << said();
  std::ranges::nth_element(waits, waits.begin() + 18);
  EXPECT_LE(waits[18], 25'000) << "on a busy machine, some are late";
}

// A driver that a team writes on Tether's library, among programs that know nothing of it: what it
// waits for delays nobody, and what it computes is charged to the program.
TEST_F(AsIsGroup, AProgramOnTheClientLibraryReadsBesideOthers) {
  write_text(folder_ / "driver.py", R"(
import threading, time, tether
vehicle = tether.connect()
def read(sensor, count):
    stamps_s, ages_s = [], []
    for _ in range(count):
        stamps_s.append(sensor.read().sampled_at_ns / 1e9)
        ages_s.append(vehicle.now_s() - stamps_s[-1])
    assert all(b > a for a, b in zip(stamps_s, stamps_s[1:])), stamps_s
    # The IMU of 20 Hz has no delay; what is more is that the other thread and the other process computed.
    assert sorted(ages_s)[count // 2] < 0.02, ages_s
imu = threading.Thread(target=read, args=(vehicle.imu(0), 40))
imu.start()
read(vehicle.range(0), 50)
imu.join()
begin_s = vehicle.now_s()
assert abs(begin_s + 1000 - time.monotonic()) < 0.01
vehicle.sleep_for(0.3)
assert 0.3 <= vehicle.now_s() - begin_s < 0.32
vehicle.command_velocity(up_m_s=0.0)
)");
  write_text(folder_ / "other.py", R"(
import time
late_s = []
for _ in range(150):
    until_s = time.monotonic() + 0.013
    time.sleep(0.013)
    late_s.append(time.monotonic() - until_s)
assert sorted(late_s)[75] < 0.002, late_s
)");
  flight_controller_ = "none";
  const Output output =
      fly(with_library() + "python3 " + (folder_ / "other.py").string() + " &\npython3 " +
          (folder_ / "driver.py").string() + " || exit 1\nwait %1\n");
  EXPECT_EQ(read_result(folder_ / "out")["suts"][0]["reached_goal"], true) << output.err << said();
  EXPECT_THAT(run(tether({"timing", folder_ / "out"})).out, HasSubstr("“python3 driver.py” takes"))
      << "each process is a stage";
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
}

TEST_F(AsIsGroup, ProgramsThatShareASensorMakeTheAnswerDoubtful) {
  flight_controller_ = "none";
  write_text(folder_ / "read.py", R"(
import sys, tether
vehicle = tether.connect()
sensor = vehicle.imu(0) if sys.argv[1] == "imu" else vehicle.range(0)
for _ in range(20):
    sensor.read()
)");
  const std::string read = "python3 " + (folder_ / "read.py").string();
  for (const bool is_shared : {false, true}) {
    const std::string other = read + (is_shared ? " imu" : " range");
    const Output output =
        fly(with_library() + other + " &\n" + read + " imu || exit 1\nwait %1\n" + read + " imu\n");
    const auto result = read_result(folder_ / "out");
    EXPECT_EQ(result["suts"][0]["reached_goal"], true) << output.err << said();
    const std::string warnings = result.value("warnings", nlohmann::json::array()).dump();
    EXPECT_EQ(warnings.find("share the measurements of sensor 'imu'") != std::string::npos,
              is_shared)
        << warnings;
  }
}

// By real time, what is outside answers; ET goes on as fast as the simulation meanwhile.
TEST_F(AsIsGroup, WhatIsWaitedForOutsideMakesTheAnswerDoubtful) {
  const std::string lock = folder_ / "lock";
  write_text(folder_ / "hold.sh",
             "exec 9>" + lock + "\nflock -x 9\ntouch " + lock + ".held\nsleep 1\n");
  Process holder({{"/bin/bash", (folder_ / "hold.sh").string()}, {}});
  ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(lock + ".held"); }));
  const Output output = fly("exec 9>" + lock + "\nflock -x 9\ntimeout 0.5 sleep 9\nexit 0\n");
  expect_exit_0(output);
  EXPECT_THAT(read_result(folder_ / "out")["warnings"].dump(),
              HasSubstr("waits for a lock of one that it did not start"));
}

TEST_F(AsIsGroup, TheEndOfTheFirstProcessEndsAll) {
  const std::string own = "sleep 1000." + std::to_string(::getpid());  // no other test's
  EXPECT_EQ(fly(own + " &\nsetsid " + own + "1 &\nsleep 0.1\nexit 5\n").code, 3);
  EXPECT_THAT(said(), testing::IsEmpty());
  const Output killed = fly(own + " &\nkill -SEGV $$\n");
  EXPECT_EQ(killed.code, 3);
  EXPECT_THAT(killed.err, HasSubstr("signal 11"));
  EXPECT_EQ(fly(own + " &\nwait\n", 1.0, 2).code, 1) << "the time limit";
  EXPECT_EQ(run({{"pgrep", "-f", "^" + own}, {}}).code, 1) << "nothing is left";
}

}  // namespace
}  // namespace tether::system_test

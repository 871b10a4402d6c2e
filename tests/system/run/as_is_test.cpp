#include "support/trials.h"

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// Programs that know nothing of Tether fly: their clocks are ET, their waits are interactions,
/// their UDP port is that of the flight controller, and /dev/video0 is the UAV's camera.
namespace tether::system_test {
namespace {

class AsIs : public testing::Test {
 protected:
  /// Runs a Python program, or the command of a program, with that limit of ST.
  Output fly(const std::string& command, int limit_s = 30) const {
    const auto file = folder_ / "as_is.toml";
    write_text(file,
               "name = \"as_is\"\nworld = \"yard\"\ntime_limit_s = " + std::to_string(limit_s) +
                   "\n[[uav]]\nname = \"uav1\"\nmodel = \"" + model_ +
                   "\"\n"
                   "position_m = [0.0, 0.0, 0.1]\nflight_controller = \"built-in\"\n"
                   "profile = \"paper_streaming\"\n"
                   "[sut]\ncommand = [" +
                   command +
                   "]\nas_is = true\n"
                   "[[condition]]\nname = \"host\"\npolicy = \"conservative_barrier\"\n"
                   "clock = \"cpu\"\ncpu_factor = 1.0\n");
    return run(tether({"run", file, "--quiet", "--force", "--out", folder_ / "out"}));
  }
  Output fly_python(const std::string& program, int limit_s = 30) const {
    write_text(folder_ / "program.py", program);
    return fly("\"" + interpreter_ + "\", \"" + (folder_ / "program.py").string() + "\"", limit_s);
  }
  void expect_only_fast(const std::string& scenario) {
    const auto out = folder_ / "out";
    for (const bool is_fast : {true, false}) {
      const Output output = run(tether({"run", scenario, "--quiet", "--force", "--condition",
                                        is_fast ? "host" : "target", "--out", out}));
      EXPECT_EQ(output.code, is_fast ? 0 : 1) << output.err << said();
      EXPECT_EQ(audit_code(out), 0);
      if (is_fast) record_of_fast_ = read_record(out);
    }
  }
  /// Of a program that does nothing with its UAV, whose flight then fails.
  void expect_exit_0(const Output& output) const {
    EXPECT_THAT(result()["suts"][0]["outcome"].get<std::string>(),
                testing::HasSubstr("exit code 0"))
        << output.err << said();
  }
  std::string said() const { return read_text(folder_ / "out" / "sut-uav1.log"); }
  nlohmann::json result() const { return read_result(folder_ / "out"); }

  TempFolder folder_;
  record::Record record_of_fast_;
  std::string interpreter_ = "python3";
  std::string model_ = "hummingbird";
};

// Ten fixes a second, each with the time at which it was measured.
TEST_F(AsIs, AReceiverOfSatelliteNavigationIsASerialPort) {
  std::string model = read_text(TETHER_SOURCE_DIR "/data/models/hummingbird/model.sdf");
  model.insert(model.find("</link>"),
               "<sensor name=\"gnss\" type=\"navsat\"><update_rate>10</update_rate></sensor>");
  model_ = folder_ / "own.sdf";
  write_text(model_, model);
  const Output output = fly_python(R"(
import select, time
port = open("/dev/ttyACM1", "r+b", buffering=0)
text, begin = b"", time.monotonic()
port.write(b"\xb5\x62settings")
while time.monotonic() - begin < 2.05:
    if select.select([port], [], [], 0.3)[0]:
        text += port.read(500)
until_s = time.monotonic() - 1000
fixes = [line.split(b",") for line in text.split(b"\r\n") if line.startswith(b"$GNGGA")]
times = [float(fix[1]) for fix in fixes]
assert len(times) >= 20 and times[0] == 0 and times[-1] <= until_s, (times, until_s)
assert all(abs(b - a - 0.1) < 2e-3 for a, b in zip(times, times[1:])), times
assert all(fix[6] == b"1" for fix in fixes)
)");
  // A busy disk can leave the answer in doubt.
  EXPECT_EQ(result()["outcome"], "goal_reached") << output.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
}

/// By Debian's Python, for which there is a package of OpenCV.
class AsIsCamera : public AsIs {
 protected:
  AsIsCamera() { interpreter_ = "/usr/bin/python3"; }
};

// Waits of 20 ms by each function; what they take longer is what the program computed.
TEST_F(AsIs, EveryWayToWaitTakesItsTimeByEveryClock) {
  constexpr long kWait_us = 20'000, kMost_us = 23'000;
  const Output output = fly("\"" WAITS_PROGRAM "\"");
  expect_exit_0(output);
  std::istringstream lines(said());
  int ways = 0;
  std::string name;
  for (long monotonic_us = 0, real_us = 0; lines >> name >> monotonic_us >> real_us; ++ways) {
    if (name == "woken_beside_computing") continue;
    if (name == "beside_computing") {
      EXPECT_GE(monotonic_us, 40'000);
      const long used_us = real_us;
      EXPECT_LE(monotonic_us, used_us + 3'000) << "the computing thread's time, and no wait's";
      continue;
    }
    EXPECT_GE(monotonic_us, kWait_us) << name;
    EXPECT_LE(monotonic_us, kMost_us) << name;
    EXPECT_NEAR(static_cast<double>(real_us), static_cast<double>(monotonic_us), 500.0) << name;
  }
  EXPECT_EQ(ways, 38);
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
}

TEST_F(AsIs, WhatTheProgramSawIsItsExecutionTime) {
  const Output output = fly_python(
      "import time\nbegin = time.monotonic()\n"
      "for i in range(50):\n"
      "    time.sleep(0.02)\n"
      "    sum(range(10000))\n"
      "up = float(open('/proc/uptime').read().split()[0])\n"
      "assert abs(up - time.monotonic()) < 0.02, up\n"
      "print(time.monotonic() - 1000.0)\n");
  expect_exit_0(output);
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
  EXPECT_GE(empty, 15);  // threads drift apart, more on a busy machine
  EXPECT_LE(empty, 31);
  EXPECT_NEAR(took_s, 1.0, 0.05);
}

TEST_F(AsIs, TheExitCodeDecides) {
  EXPECT_EQ(fly_python("import socket, sys\n"
                       "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
                       "s.bind(('', 14540))\n"
                       "s.sendto(b'x', s.recvfrom(1000)[1])\n"
                       "sys.exit(5)\n")
                .code,
            1);
  EXPECT_EQ(result()["suts"][0]["outcome"], "the program ended with exit code 5");
  const Output nothing = fly_python("import time, sys\ntime.sleep(1)\nsys.exit(5)\n");
  EXPECT_EQ(nothing.code, 3) << "it says nothing about its computer";
  EXPECT_THAT(nothing.err, testing::HasSubstr("ended before it sent anything or read a sensor"));
}

// From a command line alone: the scenario is made, and is one like any other.
TEST_F(AsIs, FliesWithoutAScenarioFile) {
  write_text(folder_ / "fly.py",
             "import socket, time\n"
             "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
             "s.bind(('', 14540))\n"
             "s.sendto(b'x', s.recvfrom(1000)[1])\n"
             "time.sleep(2)\n");
  const auto fly_here = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "run");
    Command command = tether(words);
    command.working_folder = folder_.path();
    return run(command);
  };
  const Output first = fly_here({"--", "python3", "fly.py"});
  EXPECT_EQ(first.code, 0) << first.err;
  const std::string file = "out/fly/scenario.toml";
  EXPECT_NE(first.out.find("to change and to fly again: " + file), std::string::npos) << first.out;
  EXPECT_NE(first.out.find(file + " --condition host"), std::string::npos) << first.out;

  EXPECT_EQ(fly_here({file, "--quiet", "--condition", "target"}).code, 0);
  EXPECT_EQ(fly_here({"--quiet", "--time-limit", "1", "--cpu-factor", "2", "--out", "late", "--",
                      "python3", "fly.py"})
                .code,
            1);
  EXPECT_EQ(read_result(folder_ / "late")["condition"], "target");
  EXPECT_EQ(read_result(folder_ / "late")["cpu_factor"], 2.0);
  EXPECT_EQ(fly_here({"--out", "late", "--", "python3", "fly.py"}).code, 2);  // there is a run
  EXPECT_NE(read_text(folder_ / "late/scenario.toml").find("max_s = 1\n"), std::string::npos);
}

TEST_F(AsIs, AProgramThatCrashesIsNamedAndNothingHangs) {
  const Output output =
      fly_python("import os, signal, time\ntime.sleep(1)\nos.kill(os.getpid(), signal.SIGSEGV)\n");
  EXPECT_EQ(output.code, 3);
  EXPECT_NE(output.err.find("signal 11"), std::string::npos) << output.err;
}

TEST_F(AsIs, AProgramThatGoesOnIsEndedAtTheTimeLimitAndToldIfItUsesNothing) {
  EXPECT_EQ(fly_python("import time\nwhile True: time.sleep(0.1)\n", 11).code, 1);
  EXPECT_NEAR(result()["sync"]["st_at_end_s"].get<double>(), 11.0, 0.11);
  EXPECT_NE(said().find("has used nothing of the UAV"), std::string::npos) << said();
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
  expect_exit_0(output);
  EXPECT_NE(said().find("all went well"), std::string::npos) << said();
}

// A timer by a clock that only the machine has; and another computer, which need not be there.
TEST_F(AsIs, WhatIsNotCoveredIsToldAndTheAnswerHasIt) {
  const Output output = fly_python(
      "import ctypes, socket, time\n"
      "CLOCK_BOOTTIME_ALARM = 9\n"
      "ctypes.CDLL(None).timerfd_create(CLOCK_BOOTTIME_ALARM, 0)\n"
      "s = socket.socket()\n"
      "s.setblocking(False)\n"
      "s.connect_ex(('192.0.2.1', 9))\n"
      "socket.socket().connect_ex(('127.0.0.1', 9))\n"
      "time.sleep(0.2)\n");
  expect_exit_0(output);
  for (const char* what : {"uses timerfd_create, which follows the machine's clock",
                           "talks to another computer (192.0.2.1)"}) {
    EXPECT_NE(said().find(what), std::string::npos) << said();
    EXPECT_NE(result()["warnings"].dump().find(what), std::string::npos) << result();
  }
  EXPECT_EQ(said().find("127.0.0.1"), std::string::npos) << said();
}

// Its handlers run at ET, and Python's waits go on after them.
TEST_F(AsIs, TimersOfPythonThatSendSignalsAreAtExecutionTime) {
  const Output output = fly_python(
      "import signal, time\n"
      "seen = []\n"
      "signal.signal(signal.SIGALRM, lambda *_: seen.append(time.monotonic()))\n"
      "begin = time.monotonic()\n"
      "signal.setitimer(signal.ITIMER_REAL, 0.1, 0.1)\n"
      "time.sleep(1.05)\n"
      "signal.setitimer(signal.ITIMER_REAL, 0)\n"
      "signal.alarm(3)\n"
      "signal.pause()\n"
      "print(len(seen), *(t - begin for t in seen))\n");
  expect_exit_0(output);
  std::istringstream words(said());
  std::size_t count = 0;
  ASSERT_TRUE(words >> count) << said();
  EXPECT_EQ(count, 11U) << said();
  double seen_s = 0.0;
  for (std::size_t i = 1; words >> seen_s; ++i) {
    const double at_s = i <= 10 ? 0.1 * static_cast<double>(i) : 4.05;
    EXPECT_GE(seen_s, at_s);
    EXPECT_LE(seen_s, at_s + 0.01);
  }
}

struct SeenImage {
  std::string how;
  long number = 0, age_us = 0, waited_us = 0;
  bool is_bright = false;
};

// The camera has 30 Hz and a delay of 37.4 ms. What is more is what the program computed.
TEST_F(AsIsCamera, IsAVideoDeviceWhoseBuffersOverflow) {
  constexpr long kDelay_us = 37'400, kPeriod_us = 33'334, kMost_us = 3'000;
  const Output output = fly("\"" CAMERA_PROGRAM "\"");
  ASSERT_EQ(output.code, 0) << output.err << said();
  std::istringstream lines(said());
  std::vector<SeenImage> seen;
  for (SeenImage s; lines >> s.how >> s.number >> s.age_us >> s.waited_us >> s.is_bright;)
    seen.push_back(s);
  ASSERT_EQ(seen.size(), 10U) << said();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(seen[i].number, static_cast<long>(i)) << seen[i].how;
    EXPECT_GE(seen[i].age_us, kDelay_us) << seen[i].how;
    EXPECT_LE(seen[i].age_us, kDelay_us + kMost_us) << seen[i].how;
    EXPECT_LE(seen[i].waited_us, (i == 0 ? kDelay_us : 0) + kPeriod_us + kMost_us);
    EXPECT_TRUE(seen[i].is_bright);
  }
  // It computed for twelve periods: the oldest four wait, eight are lost.
  for (std::size_t i = 4; i < 8; ++i) {
    EXPECT_EQ(seen[i].number, static_cast<long>(i));
    EXPECT_LE(seen[i].waited_us, kMost_us * 4) << "it is there";
    EXPECT_GE(seen[i].age_us, 400'000 - static_cast<long>(i - 4) * kPeriod_us);
  }
  EXPECT_NEAR(static_cast<double>(seen[8].number), 16.0, 1.0);
  EXPECT_LE(seen[8].age_us, kDelay_us + kMost_us);
  EXPECT_EQ(seen[9].number, seen[8].number + 1);
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  for (const auto& entry : read_record(folder_ / "out").interactions) {
    const SimTime replied_at = same_instant(entry.message.reply_at);
    EXPECT_GE(replied_at, entry.message.available_at.value_or(replied_at));
  }
}

// By GStreamer if that has its plugins, and by V4L2. GStreamer's threads are charged as well, and
// may compute in parallel: then there is no answer (3).
TEST_F(AsIsCamera, OpencvOfPythonReadsTheCameraAtItsRate) {
  const Output output = fly_python(
      "import cv2, threading, time\n"
      "for backend in cv2.CAP_ANY, cv2.CAP_V4L2:\n"
      "    camera = cv2.VideoCapture(0, backend)\n"
      "    assert camera.isOpened(), 'no camera'\n"
      "    assert camera.get(cv2.CAP_PROP_FPS) == 30\n"
      "    camera.read()\n"
      "    begin = time.monotonic()\n"
      "    for i in range(30): ok, image = camera.read()\n"
      "    assert ok and image.shape == (480, 640, 3) and image.mean() > 5\n"
      "    assert 0.8 < time.monotonic() - begin < 1.6, time.monotonic() - begin\n"
      "    camera.release()\n"
      "camera = cv2.VideoCapture(0, cv2.CAP_V4L2)\n"
      "jpeg = cv2.VideoWriter_fourcc(*'MJPG')\n"
      "assert camera.set(cv2.CAP_PROP_FOURCC, jpeg) and camera.get(cv2.CAP_PROP_FOURCC) == jpeg\n"
      "decoded = camera.read()[1]\n"
      "assert cv2.absdiff(decoded, image).mean() < 6, cv2.absdiff(decoded, image).mean()\n"
      "camera.release()\n"
      "assert not cv2.VideoCapture(1).isOpened()\n"
      "print('all went well')\n");
  EXPECT_TRUE(output.code == 0 || output.code == 3) << output.err << said();
  EXPECT_NE(said().find("all went well"), std::string::npos) << said();
  EXPECT_NE(said().find("looked for /dev/video1"), std::string::npos) << said();
}

// One thread reads, another one computes all the time with the newest image: the usual way.
TEST_F(AsIsCamera, AThreadReadsTheCameraBesideOneThatComputes) {
  const Output output = fly_python(
      "import cv2, threading, time\n"
      "cv2.setNumThreads(1)\n"
      "camera = cv2.VideoCapture(0, cv2.CAP_V4L2)\n"
      "newest, count, ends = None, 0, False\n"
      "def capture():\n"
      "    global newest, count\n"
      "    while not ends:\n"
      "        newest = camera.read()[1]\n"
      "        count += 1\n"
      "thread = threading.Thread(target=capture)\n"
      "thread.start()\n"
      "while newest is None: time.sleep(0.005)\n"
      "begin, before = time.monotonic(), count\n"
      "while time.monotonic() - begin < 0.5: cv2.blur(newest, (9, 9))\n"
      "print(count - before)\n"
      "ends = True\n"
      "thread.join()\n");
  EXPECT_EQ(output.code, 0) << output.err << said();
  EXPECT_NEAR(std::stod(said()), 15.0, 2.0) << said();
}

/// Whole frames in pieces, and the answer from a stream of bytes, which `opening` opens as `fd`.
std::string arms_over(const std::string& opening, const std::string& flushing) {
  return "import os, select, socket, sys, termios, time, tty\n"
         "sys.dont_write_bytecode = True\n"
         "sys.path.insert(0, '" TETHER_SOURCE_DIR
         "/data/programs')\n"
         "import mavlink_square as m\n" +
         opening +
         "class Line:\n"
         "    def sendto(self, data, _):\n"
         "        for byte in data: os.write(fd, bytes([byte]))\n"
         "controller = m.FlightController.__new__(m.FlightController)\n"
         "controller.link, controller.address, controller.sequence = Line(), None, 0\n"
         "controller.last, buffer = {}, b''\n"
         "def listen(wanted):\n"
         "    global buffer\n"
         "    while wanted not in controller.last:\n"
         "        assert select.select([fd], [], [], 2.0)[0]\n"
         "        buffer += os.read(fd, 4096)\n"
         "        while len(buffer) > 2 and len(buffer) >= buffer[1] + 12:\n"
         "            assert buffer[0] == 0xFD\n"
         "            controller.take(buffer[:buffer[1] + 12])\n"
         "            buffer = buffer[buffer[1] + 12:]\n"
         "listen(m.HEARTBEAT)\n"
         "time.sleep(2)\n" +
         flushing +
         "controller.send(m.COMMAND, 1, 0, 0, 0, 0, 0, 0, m.ARM, 1, 1, 0)\n"
         "listen(m.ACK)\n"
         "print('acknowledged', controller.last.pop(m.ACK))\n"
         "controller.send(m.COMMAND, 0, 0, 0, 0, 0, 0, 0, 300, 1, 1, 0)\n"  // of no mission
         "listen(m.ACK)\n";
}

TEST_F(AsIs, ASerialPortLeadsToTheFlightController) {
  const Output output =
      fly_python(arms_over("fd = os.open('/dev/ttyACM0', os.O_RDWR | os.O_NOCTTY)\n"
                           "assert os.isatty(fd) and os.path.exists('/dev/ttyACM0')\n"
                           "tty.setraw(fd)\n"
                           "mode = termios.tcgetattr(fd)\n"
                           "mode[4] = mode[5] = termios.B921600\n"
                           "termios.tcsetattr(fd, termios.TCSANOW, mode)\n",
                           "termios.tcflush(fd, termios.TCIFLUSH)\n"
                           "buffer = b''\n"));
  EXPECT_EQ(output.code, 0) << output.err << said();
  EXPECT_NE(said().find("acknowledged {'command': 400, 'result': 0}"), std::string::npos) << said();
}

// What waits for it is read, all of it.
TEST_F(AsIs, ATcpConnectionLeadsToTheFlightController) {
  const Output output =
      fly_python(arms_over("link = socket.create_connection(('127.0.0.1', 5760), 3.0)\n"
                           "assert link.getpeername() == ('127.0.0.1', 5760)\n"
                           "fd = link.fileno()\n",
                           ""));
  EXPECT_EQ(output.code, 0) << output.err << said();
  EXPECT_NE(said().find("acknowledged {'command': 400, 'result': 0}"), std::string::npos) << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  std::string doubts;
  const nlohmann::json flight = result();
  for (const auto& warning : flight.at("warnings"))
    doubts += warning.at("message").get<std::string>();
  EXPECT_NE(doubts.find("its last request for the start of a mission was denied"),
            std::string::npos)
      << doubts;
}

// The same program by MAVLink: a fast computer reaches the corners, a slow one does not.
TEST_F(AsIs, AnUnmodifiedCompanionFliesASquareAndASlowOneDoesNot) {
  expect_only_fast("mavlink_square");
  EXPECT_GT(record_of_fast_.autopilot.size(), 1000U);
}

// The flight controller waits for missions that are planned in flight.
TEST_F(AsIs, AnUnmodifiedCompanionFliesMissionsAndASlowOneTakesTooLong) {
  expect_only_fast("mavlink_mission");
}

// By its camera: the slow one works on images that have waited in its buffers.
TEST_F(AsIsCamera, AnUnmodifiedCompanionFacesABoxAndASlowOneDoesNot) {
  expect_only_fast("mavlink_face_anchor");
}

}  // namespace
}  // namespace tether::system_test

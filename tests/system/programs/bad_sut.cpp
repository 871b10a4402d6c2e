// A SUT that behaves well or badly: bad_sut MODE
//
// Every mode but those of the start first flies in small steps for 1.5 s of its time.
// kill_PHASE and stop_PHASE: SIGKILL or SIGSTOP strikes it there.
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <tether/client/simulated_vehicle.h>
#include <tether/link/codec.h>

namespace {

using namespace std::chrono_literals;
using tether::client::Vehicle;
constexpr int kSteps = 100;

// ---- A clock that may lie

std::atomic<std::int64_t> g_ahead_ns{0};  // of what it truly measures

class LyingSource final : public tether::client::TimeSource {
 public:
  explicit LyingSource(std::unique_ptr<TimeSource> right) : right_(std::move(right)) {}
  tether::computer::Clock clock() const override { return right_->clock(); }
  tether::Duration elapsed() const override {
    return right_->elapsed() + tether::Duration(g_ahead_ns.load());
  }
  tether::Duration elapsed_at_resume() const override {
    return right_->elapsed_at_resume() + tether::Duration(g_ahead_ns.load());
  }
  void hold() const override { right_->hold(); }
  tether::Duration elapsed_in_children() const override { return right_->elapsed_in_children(); }
  tether::Status complete() const override { return right_->complete(); }
  void exclude_calling_thread() override { right_->exclude_calling_thread(); }
  void release_calling_thread() override { right_->release_calling_thread(); }

 private:
  std::unique_ptr<TimeSource> right_;
};

void lie_by(tether::Duration ahead) {
  g_ahead_ns = ahead.count();
}

// ---- Well-behaved parts

std::unique_ptr<Vehicle> join() {
  auto options = tether::client::options_from_environment();
  if (!options) {
    std::fprintf(stderr, "bad_sut: %s\n", options.failure().message.c_str());
    std::exit(2);
  }
  options->sut_name = "bad_sut";
  if (options->time) options->time = std::make_unique<LyingSource>(std::move(options->time));
  auto vehicle = tether::client::connect(std::move(options).value());
  if (vehicle) return std::move(vehicle).value();
  std::fprintf(stderr, "bad_sut: %s\n", vehicle.failure().message.c_str());
  std::exit(3);
}

void require(const tether::Status& status) {
  if (status) return;
  std::fprintf(stderr, "bad_sut: %s\n", status.failure().message.c_str());
  std::exit(3);
}

void fly(Vehicle& vehicle, int steps) {
  for (int i = 0; i < steps; ++i) {
    const double yaw_rate_rad_s = i % 20 < 10 ? 0.3 : -0.3;
    require(vehicle.command_velocity({.velocity_H_m_s = {}, .yaw_rate_rad_s = yaw_rate_rad_s}));
    require(vehicle.sleep_for(10ms));
    const auto range = vehicle.read<tether::uav::RangeSample>("range");
    require(range ? tether::ok_status() : tether::Status(range.failure()));
    require(vehicle.annotate("step", "{\"i\": " + std::to_string(i) + "}"));
    require(vehicle.sleep_for(3ms));
  }
}

// Every kind of call, on the way down to the floor.
void fly_down(Vehicle& vehicle, bool exchanges) {
  require(vehicle.command_velocity({.velocity_H_m_s = {0.4, 0.0, -1.0}, .yaw_rate_rad_s = 0.3}));
  const std::vector<std::uint8_t> bytes(200);
  for (int i = 0; i < 60; ++i) {
    require(vehicle.begin_stage("read"));
    if (vehicle.catalogue().battery_capacity_C > 0.0) {
      const auto battery = vehicle.read_battery();
      require(battery ? tether::ok_status() : tether::Status(battery.failure()));
    }
    require(vehicle.end_stage());
    if (exchanges) {
      require(vehicle.send("", bytes));
      (void)vehicle.receive(4ms);
    }
    require(vehicle.sleep_for(20ms));
  }
}

int finish(Vehicle& vehicle, bool reached) {
  require(vehicle.finish(reached, reached ? "flown" : "not flown", "{}"));
  return reached ? 0 : 1;
}

// ---- A socket of its own, for what the client library would never send

int connect_socket(int receive_buffer = 0) {
  const std::string address = std::getenv("TETHER_ADDRESS");
  const auto colon = address.rfind(':');
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1))));
  inet_pton(AF_INET, address.substr(0, colon).c_str(), &to.sin_addr);
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  if (receive_buffer > 0)
    setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  if (connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) std::exit(4);
  return fd;
}

void send_all(int fd, const void* bytes, std::size_t size) {
  if (write(fd, bytes, size) != static_cast<ssize_t>(size)) std::exit(4);
}

tether::link::Hello hello_of_this_run() {
  tether::link::Hello hello;
  hello.sut = "bad_sut";
  const auto time = tether::client::parse_time_source(std::getenv("TETHER_CLOCK")).value();
  hello.clock = time->clock();
  hello.token = std::getenv("TETHER_TOKEN");
  hello.uav = std::getenv("TETHER_UAV");
  return hello;
}

void send_hello(int fd, const tether::link::Hello& hello) {
  tether::link::Encoder encoder;
  const auto frame = encoder.encode(hello);
  send_all(fd, frame.data(), frame.size());
  char buffer[4096];
  if (read(fd, buffer, sizeof buffer) <= 0) std::exit(4);  // the Welcome
}

// ---- Struck by a signal

[[noreturn]] void wait_for_ever() {
  while (true) pause();
}

struct Strike {
  int signal;
  std::string phase;
};

std::optional<Strike> strike_of(const std::string& mode) {
  if (mode.rfind("kill_", 0) == 0) return Strike{SIGKILL, mode.substr(5)};
  if (mode.rfind("stop_", 0) == 0) return Strike{SIGSTOP, mode.substr(5)};
  return std::nullopt;
}

// Under the barrier, its reply is long in coming; that of the camera is more than the buffers take.
tether::link::Request far_request(const std::string& phase) {
  tether::link::Request request{.sequence = 1, .issued_at = {}, .body = {}};
  if (phase == "reply_half") {
    request.body = tether::link::ReadSensor{};
  } else if (phase == "finishing") {
    request.issued_at = tether::ExecTime(4s);
    request.body = tether::link::Finish{true, "flown", "{}"};
  } else {
    request.body = tether::link::Sleep{tether::ExecTime(4s)};
  }
  return request;
}

void send_far_request(int fd, const std::string& phase) {
  tether::link::Encoder encoder;
  const auto frame = encoder.encode(far_request(phase));
  send_all(fd, frame.data(), phase == "request_half" ? frame.size() / 2 : frame.size());
}

// Before it flies; returns where that phase comes later.
void strike_on_the_wire(const Strike& strike) {
  const std::string& phase = strike.phase;
  if (phase == "connecting") std::raise(strike.signal);
  if (phase == "joined" || phase == "computing" || phase == "finished") return;
  const int fd = connect_socket(phase == "reply_half" ? 32'768 : 0);
  if (phase == "connected") std::raise(strike.signal);
  send_hello(fd, hello_of_this_run());
  send_far_request(fd, phase);
  constexpr int kMoreThanAWelcome = 8192;
  int unread = 0;
  do {
    std::this_thread::sleep_for(300ms);
    ioctl(fd, FIONREAD, &unread);
  } while (phase == "reply_half" && unread < kMoreThanAWelcome);
  std::raise(strike.signal);
  wait_for_ever();
}

int struck(const Strike& strike) {
  strike_on_the_wire(strike);
  const auto vehicle = join();
  std::puts("joined");
  std::fflush(stdout);
  if (strike.phase == "joined") std::raise(strike.signal);
  fly(*vehicle, kSteps);
  if (strike.phase == "computing") std::raise(strike.signal);
  const int code = finish(*vehicle, true);
  if (strike.phase == "finished") std::raise(strike.signal);
  return code;
}

// ---- The modes

[[noreturn]] void crash() {
  prctl(PR_SET_DUMPABLE, 0);  // no core file
  std::signal(SIGSEGV, SIG_DFL);
  std::raise(SIGSEGV);
  std::abort();
}

[[noreturn]] void compute_for_ever() {
  volatile bool for_ever = true;
  while (for_ever) {
  }
  std::abort();
}

// Helper processes that nobody waits for, the second in a session of its own and without a parent.
void leave_children() {
  if (fork() == 0) wait_for_ever();
  const pid_t parent = fork();
  if (parent != 0) {
    waitpid(parent, nullptr, 0);
    return;
  }
  setsid();
  if (fork() == 0) wait_for_ever();
  _exit(0);
}

void compute(std::chrono::milliseconds cpu_time) {
  timespec begin{}, now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
  do {
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  } while (std::chrono::seconds(now.tv_sec - begin.tv_sec) +
               std::chrono::nanoseconds(now.tv_nsec - begin.tv_nsec) <
           cpu_time);
}

// In each way for 60 ms. All but the call, and the computing of 60 ms, is hidden from the
// simulator.
int wait_in_every_way(Vehicle& v) {
  std::condition_variable never;
  std::mutex mutex;
  std::unique_lock lock(mutex);
  never.wait_for(lock, 60ms);
  for (int i = 0; i < 10; ++i) poll(nullptr, 0, 6);
  std::thread([] { std::this_thread::sleep_for(60ms); }).join();
  const pid_t child = fork();
  if (child == 0) {
    std::this_thread::sleep_for(60ms);
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  for (int i = 0; i < 60; ++i) {
    require(v.sleep_for(1ms));
    compute(1ms);
    std::this_thread::sleep_for(1ms);
  }
  std::this_thread::sleep_for(60ms);  // and finishes
  return finish(v, true);
}

// Computes 400 ms on this thread and on short-lived ones, one at a time or `together`.
int compute_on_threads(Vehicle& v, bool together) {
  for (int i = 0; i < 20; ++i) {
    std::thread other([] { compute(10ms); });
    if (!together) other.join();
    compute(10ms);
    if (together) other.join();
    require(v.sleep_for(1ms));
  }
  return finish(v, true);
}

const std::map<std::string, std::function<int(Vehicle&)>> kFlyingModes = {
    {"good", [](Vehicle& v) { return finish(v, true); }},
    {"latest",
     [](Vehicle& v) {
       for (int i = 0; i < kSteps; ++i) {
         const auto imu = v.read<tether::uav::ImuSample>("imu", tether::client::Read::kLatest);
         require(imu ? tether::ok_status() : tether::Status(imu.failure()));
         require(v.sleep_for(10ms));
       }
       return finish(v, true);
     }},
    // Dives into the floor, and claims success.
    {"ram",
     [](Vehicle& v) {
       require(v.command_velocity({.velocity_H_m_s = {0.0, 0.0, -2.0}, .yaw_rate_rad_s = 0.0}));
       require(v.sleep_for(2s));
       return finish(v, true);
     }},
    {"fly_down",
     [](Vehicle& v) {
       fly_down(v, false);
       return finish(v, true);
     }},
    {"exchange",
     [](Vehicle& v) {
       fly_down(v, true);
       return finish(v, true);
     }},
    {"wait", wait_in_every_way},
    {"in_turn", [](Vehicle& v) { return compute_on_threads(v, false); }},
    {"together", [](Vehicle& v) { return compute_on_threads(v, true); }},
    {"missed", [](Vehicle& v) { return finish(v, false); }},
    {"crash", [](Vehicle&) -> int { crash(); }},
    {"stop", [](Vehicle&) { return std::raise(SIGSTOP); }},
    {"compute", [](Vehicle&) -> int { compute_for_ever(); }},
    {"idle", [](Vehicle&) -> int { wait_for_ever(); }},
    {"exit", [](Vehicle&) -> int { _exit(0); }},
    {"sleep_long",
     [](Vehicle& v) -> int {
       while (true) require(v.sleep_for(1s));
     }},
    {"stubborn",
     [](Vehicle&) -> int {
       std::signal(SIGTERM, SIG_IGN);
       compute_for_ever();
     }},
    {"child",
     [](Vehicle& v) {
       leave_children();
       return finish(v, true);
     }},
    {"deaf",
     [](Vehicle& v) {
       std::signal(SIGCHLD, SIG_IGN);
       return finish(v, true);
     }},
    {"fly_on",
     [](Vehicle& v) -> int {
       while (true) fly(v, 1);
     }},
    {"look",
     [](Vehicle& v) -> int {
       const auto image = v.read<tether::uav::CameraSample>("camera");
       require(image ? tether::ok_status() : tether::Status(image.failure()));
       return finish(v, true);
     }},
    {"pause",
     [](Vehicle& v) -> int {
       std::puts("pausing");
       std::fflush(stdout);
       std::this_thread::sleep_for(1s);
       return finish(v, true);
     }},
    {"linger",
     [](Vehicle& v) -> int {
       finish(v, true);
       std::puts("finished");
       std::fflush(stdout);
       wait_for_ever();
     }},
    {"lie_later",
     [](Vehicle& v) -> int {
       lie_by(1h);
       require(v.sleep_for(10ms));
       return finish(v, true);
     }},
    // Only its progress messages show it.
    {"lie_in_progress",
     [](Vehicle&) -> int {
       lie_by(1h);
       compute_for_ever();
     }},
    {"lie_back",
     [](Vehicle& v) -> int {
       lie_by(-1s);
       require(v.sleep_for(10ms));
       return finish(v, true);
     }},
};

int fail_at_start(const std::string& mode) {
  if (mode == "never_connect") wait_for_ever();
  if (mode == "exit_at_start") {
    std::fprintf(stderr, "cannot open the camera\n");
    return 7;
  }
  const int fd = connect_socket();
  send_hello(fd, hello_of_this_run());
  const std::string garbage(300, 'x');  // a length of 2 GB, and no FlatBuffer
  send_all(fd, garbage.data(), garbage.size());
  wait_for_ever();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (const auto strike = strike_of(mode)) return struck(*strike);
  const auto known = kFlyingModes.find(mode);
  if (known == kFlyingModes.end()) return fail_at_start(mode);
  const auto vehicle = join();
  std::puts("joined");
  std::fflush(stdout);
  fly(*vehicle, kSteps);
  return known->second(*vehicle);
}

// A SUT that behaves as its argument says: bad_sut MODE
//
// Every mode but those of the start first flies in small steps for 1.5 s of its time.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/client/simulated_vehicle.h>
#include <tether/link/codec.h>

namespace {

using namespace std::chrono_literals;
using tether::client::Vehicle;
constexpr int kSteps = 100;

// ---- Well-behaved parts

std::unique_ptr<Vehicle> join() {
  auto options = tether::client::options_from_environment();
  if (!options) {
    std::fprintf(stderr, "bad_sut: %s\n", options.failure().message.c_str());
    std::exit(2);
  }
  options->sut_name = "bad_sut";
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
    const auto range = vehicle.read_range("range");
    require(range ? tether::ok_status() : tether::Status(range.failure()));
    require(vehicle.annotate("step", "{\"i\": " + std::to_string(i) + "}"));
    require(vehicle.sleep_for(3ms));
  }
}

int finish(Vehicle& vehicle, bool reached) {
  require(vehicle.finish(reached, reached ? "flown" : "not flown", "{}"));
  return reached ? 0 : 1;
}

// ---- A socket of its own, for what the client library would never send

int connect_socket() {
  const std::string address = std::getenv("TETHER_ADDRESS");
  const auto colon = address.rfind(':');
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1))));
  inet_pton(AF_INET, address.substr(0, colon).c_str(), &to.sin_addr);
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  if (connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) std::exit(4);
  return fd;
}

void send_all(int fd, const void* bytes, std::size_t size) {
  if (write(fd, bytes, size) != static_cast<ssize_t>(size)) std::exit(4);
}

void send_garbage(int fd) {
  const std::string garbage(300, 'x');  // a length of 2 GB, and no FlatBuffer
  send_all(fd, garbage.data(), garbage.size());
}

// What the other end says before it closes.
void drain(int fd) {
  char buffer[4096];
  while (read(fd, buffer, sizeof buffer) > 0) {
  }
}

tether::link::Hello hello_of_this_run() {
  tether::link::Hello hello;
  hello.sut = "bad_sut";
  hello.clock = tether::link::ClockKind::kCpu;
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

[[noreturn]] void wait_for_ever() {
  while (true) pause();
}

// A helper process that nobody waits for.
void leave_child() {
  if (fork() == 0) wait_for_ever();
}

const std::map<std::string, std::function<int(Vehicle&)>> kFlyingModes = {
    {"good", [](Vehicle& v) { return finish(v, true); }},
    {"latest",
     [](Vehicle& v) {
       for (int i = 0; i < kSteps; ++i) {
         const auto imu = v.read_imu("imu", tether::client::Read::kLatest);
         require(imu ? tether::ok_status() : tether::Status(imu.failure()));
         require(v.sleep_for(10ms));
       }
       return finish(v, true);
     }},
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
       leave_child();
       return finish(v, true);
     }},
    {"fly_on",
     [](Vehicle& v) -> int {
       while (true) fly(v, 1);
     }},
};

int fail_at_start(const std::string& mode) {
  if (mode == "never_connect") wait_for_ever();
  if (mode == "exit_at_start") {
    std::fprintf(stderr, "cannot open the camera\n");
    return 7;
  }
  const int fd = connect_socket();
  if (mode == "old_version") {
    auto hello = hello_of_this_run();
    hello.protocol_version = 1;
    send_hello(fd, hello);
    return 3;
  }
  if (mode == "garbage_after_hello") send_hello(fd, hello_of_this_run());
  send_garbage(fd);
  drain(fd);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  const auto known = kFlyingModes.find(mode);
  if (known == kFlyingModes.end()) return fail_at_start(mode);
  const auto vehicle = join();
  std::puts("joined");
  std::fflush(stdout);
  fly(*vehicle, kSteps);
  return known->second(*vehicle);
}

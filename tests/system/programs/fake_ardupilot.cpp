// A peer for tests that behaves at its ports as ArduPilot with its model JSON does, as far as the
// flights need: fake_ardupilot OPTIONS
//
// It sends servos to UDP --sim-port-out, and waits for the state; if none comes for 1.1 s, it sends
// the same again. Here, it sends each hundredth twice: whoever answers both gets ahead of it, and
// it exits with code 9. It takes lines, reads what it needs of them, and counts whole microseconds
// of each step. MAVLink goes to the port of --serial0; what has come from there is taken after a
// state. After two seconds, it has a position. Its parameters are those of the file --defaults.
// FAKE_END = N: it exits with code 7 after N s of its time; FAKE_UNFIT = 1: it never can be armed;
// FAKE_SERVOS = N: it has so many; FAKE_VERSION = N: the number of its version.
#include "fake_flight.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include <poll.h>
#include <unistd.h>

namespace {

using tether::mavlink::Message;
using tether::system_test::FakeFlight;
using tether::system_test::FakeRotor;
using tether::system_test::FakeState;
using tether::system_test::local;

[[noreturn]] void end(int code, const char* why) {
  std::printf("%s\n", why);
  std::exit(code);
}

/// From ArduPilot's page on motors: of a quad in + (FRAME_TYPE 0) or x configuration.
std::vector<FakeRotor> rotors(bool is_plus) {
  std::vector<FakeRotor> all;
  const double turned_deg = is_plus ? 45.0 : 0.0;
  for (const auto& [angle_deg, spin] :
       {std::pair{45.0, 1.0}, {-135.0, 1.0}, {-45.0, -1.0}, {135.0, -1.0}}) {
    const double angle = (angle_deg + turned_deg) * std::acos(-1.0) / 180.0;
    all.push_back({0.17 * std::cos(angle), 0.17 * std::sin(angle), spin});
  }
  return all;
}

/// A socket that sends to that port.
int connected(const std::string& port) {
  const sockaddr_in to = local(std::atoi(port.c_str()));
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  (void)::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  return socket;
}

class FakeArduPilot {
 public:
  explicit FakeArduPilot(std::map<std::string, std::string> options)
      : parameters_(read(options["--defaults"])),
        simulator_(connected(options["--sim-port-out"])),
        link_(connected(options["--serial0"].substr(std::strlen("udpclient:127.0.0.1:")))) {}

  [[noreturn]] void run() {
    for (;; ++step_) {
      if (pollfd waits{simulator_, POLLIN, 0}; ::poll(&waits, 1, 0) > 0)
        end(9, "ERROR [fake] a state that was not asked for");
      send_servos();
      if (step_ % 100 == 99) send_servos();
      while (!take_state()) {
        constexpr int kPatience_ms = 1100;
        pollfd waits{simulator_, POLLIN, 0};
        if (::poll(&waits, 1, kPatience_ms) == 0) send_servos();
      }
      take_messages();
      if (flight_.state.now_s > parameter("FAKE_END", INFINITY))
        end(7, "ERROR [fake] the end that was asked for");
      flight_.telemetry();
    }
  }

 private:
  static std::map<std::string, double> read(const std::string& path) {
    std::map<std::string, double> all;
    std::ifstream file(path);
    std::string name;
    for (double value = 0.0; file >> name >> value;) all[name] = value;
    return all;
  }
  double parameter(const std::string& name, double otherwise = 0.0) const {
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? otherwise : found->second;
  }

  void send_servos() {
    std::vector<std::uint16_t> words = {18458, 1200, static_cast<std::uint16_t>(step_ & 0xffff),
                                        static_cast<std::uint16_t>(step_ >> 16)};
    words.resize(4 + static_cast<std::size_t>(parameter("FAKE_SERVOS", 16.0)), 1000);
    const auto shares = flight_.shares();
    for (std::size_t i = 0; i < shares.size(); ++i)
      words[4 + i] = static_cast<std::uint16_t>(1000.0 + std::round(1000.0 * shares[i]));
    (void)!::send(simulator_, words.data(), 2 * words.size(), 0);
  }

  bool take_state() {
    char text[4096];
    const ssize_t size = ::recv(simulator_, text, sizeof text - 1, MSG_DONTWAIT);
    if (size <= 2 || text[0] != '\n' || text[size - 1] != '\n') return false;
    text[size] = '\0';
    FakeState& s = flight_.state;
    double time_s = 0.0;
    const auto get = [&](const char* key, std::initializer_list<double*> values) {
      const char* at = std::strstr(text, key);
      if (at == nullptr) end(9, "ERROR [fake] a state without all of its values");
      at += std::strlen(key);
      for (double* const value : values) {
        at += std::strspn(at, ":[,");
        char* after = nullptr;
        *value = std::strtod(at, &after);
        if (after == at) end(9, "ERROR [fake] a state with fewer numbers");
        at = after;
      }
    };
    double force[3];
    get("\"timestamp\"", {&time_s});
    get("\"gyro\"", {&s.w.x, &s.w.y, &s.w.z});
    get("\"accel_body\"", {&force[0], &force[1], &force[2]});
    get("\"position\"", {&p_.x, &p_.y, &p_.z});
    get("\"quaternion\"", {&s.q.w, &s.q.x, &s.q.y, &s.q.z});
    get("\"velocity\"", {&s.v.x, &s.v.y, &s.v.z});
    if (!flight_.is_armed) origin_ = p_;
    s.p = p_ - origin_;
    clock_us_ += static_cast<std::int64_t>((time_s - last_s_) * 1e6);
    last_s_ = time_s;
    s.now_s = static_cast<double>(clock_us_) * 1e-6;
    if (std::abs(s.now_s - time_s) > 1e-3) end(9, "ERROR [fake] my clock has lost a millisecond");
    return true;
  }

  void take_messages() {
    std::uint8_t bytes[65536];
    for (ssize_t size = 0; (size = ::recv(link_, bytes, sizeof bytes, MSG_DONTWAIT)) > 0;)
      for (const auto& frame :
           tether::mavlink::Decoder().push_datagram({bytes, static_cast<std::size_t>(size)})) {
        flight_.on_companion(frame,
                             static_cast<std::uint32_t>(parameter("FAKE_VERSION", 0x04060000)),
                             [this](int message) { report(message); });
        constexpr int kRunPrearmChecks = 401;
        if (frame.message.is("COMMAND_LONG") &&
            frame.message.integer("command") == kRunPrearmChecks && is_unfit())
          flight_.tell(Message("STATUSTEXT").set_text("text", "PreArm: unfit, as asked for"));
      }
  }

  bool is_unfit() const { return parameter("FAKE_UNFIT") > 0.0; }

  void report(int message) {
    constexpr int kSystemStatus = 1, kEstimatorReport = 193;
    if (message == kSystemStatus)
      flight_.tell(
          Message("SYS_STATUS").set("onboard_control_sensors_health", is_unfit() ? 0 : 0x10000000));
    if (message == kEstimatorReport)
      flight_.tell(
          Message("EKF_STATUS_REPORT").set("flags", flight_.state.now_s > 2.0 ? 0x3f : 0xa7));
  }

  void tell(const Message& message, tether::mavlink::Address from) {
    const auto frame = tether::mavlink::encode(message, from, sequence_++);
    (void)!::send(link_, frame.data(), frame.size(), 0);
  }

  std::map<std::string, double> parameters_;
  int simulator_, link_;
  std::uint32_t step_ = 0;
  std::int64_t clock_us_ = 0;
  double last_s_ = 0.0;
  tether::uav::Vec3 p_, origin_;
  std::uint8_t sequence_ = 0;
  FakeFlight flight_{rotors(parameter("FRAME_TYPE") == 0.0),
                     // Of the full thrust: motors turn with 15 to 95 % of their full speed.
                     std::pow(0.15 + 0.8 * std::sqrt(parameter("MOT_THST_HOVER")), 2),
                     [this](const Message& m, tether::mavlink::Address from) { tell(m, from); }};
};

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::map<std::string, std::string> options;
  for (int i = 1; i + 1 < argc; i += 2) options[argv[i]] = argv[i + 1];
  FakeArduPilot(std::move(options)).run();
}

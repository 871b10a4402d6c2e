// A peer for tests that behaves at its ports as PX4 in the loop does, as far as the flights need:
// fake_px4 -d -i INSTANCE FOLDER
//
// It connects to TCP 4560 + INSTANCE. Its clock is HIL_SENSOR. In the first two seconds of that, it
// boots, and sends no actuators. Then it listens at UDP 14580 + INSTANCE; what comes there, it
// takes and acknowledges at once, in real time, whether its clock goes on or not; then, or after 10
// ms of real time without a message, it looks whether MISSION_CURRENT is due, once a second. It
// flies: attitude from the gyroscopes, position from HIL_GPS and the accelerometers, and rotors
// where its parameters (PX4_PARAM_CA_ROTOR…) say they are. PX4_PARAM_FAKE_END = N: it exits with
// code 7 after N s of its time; PX4_PARAM_FAKE_SPIN = N: it computes without end from then on;
// PX4_PARAM_FAKE_VERSION = N: the number of its version, 0 if it tells none.
#include "fake_flight.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

using tether::mavlink::Message;
using tether::system_test::FakeFlight;
using tether::system_test::FakeRotor;
using tether::system_test::FakeState;
using tether::system_test::local;
using tether::uav::Quat;
using tether::uav::Vec3;

constexpr double kBoot_s = 2.0;

double parameter(const std::string& name, double otherwise = 0.0) {
  const char* const value = std::getenv(("PX4_PARAM_" + name).c_str());
  return value == nullptr ? otherwise : std::atof(value);
}

std::vector<FakeRotor> rotors() {
  std::vector<FakeRotor> all;
  for (int i = 0; i < static_cast<int>(parameter("CA_ROTOR_COUNT")); ++i) {
    const std::string name = "CA_ROTOR" + std::to_string(i) + "_";
    all.push_back({parameter(name + "PX"), parameter(name + "PY"),
                   parameter(name + "KM") > 0.0 ? 1.0 : -1.0});
  }
  return all;
}

// Standing level, the compass points to magnetic north; the world's field points where it points.
Quat yaw_of(const Message& m) {
  constexpr double kDeclination_rad = 0.2555;  // of (6, 23) µT east and north
  const double yaw = std::atan2(-m.number("ymag"), m.number("xmag")) + kDeclination_rad;
  return {std::cos(yaw / 2), 0.0, 0.0, std::sin(yaw / 2)};
}

class FakePx4 {
 public:
  explicit FakePx4(int instance) : remote_(local(14540 + instance)) {
    const sockaddr_in simulator = local(4560 + instance);
    do {
      ::close(stream_);
      stream_ = ::socket(AF_INET, SOCK_STREAM, 0);
      ::usleep(500);
    } while (::connect(stream_, reinterpret_cast<const sockaddr*>(&simulator), sizeof simulator) !=
             0);
    std::printf("INFO  [simulator_mavlink] Simulator connected\n");
    const sockaddr_in own = local(14580 + instance);
    datagrams_ = ::socket(AF_INET, SOCK_DGRAM, 0);
    (void)::bind(datagrams_, reinterpret_cast<const sockaddr*>(&own), sizeof own);
  }

  [[noreturn]] void run() {
    std::uint8_t bytes[65536];
    for (;;) {
      pollfd waits[2] = {{stream_, POLLIN, 0}, {datagrams_, POLLIN, 0}};
      constexpr int kLook_ms = 10;
      const bool is_idle = ::poll(waits, 2, kLook_ms) == 0;
      if (waits[1].revents != 0) {
        const ssize_t size = ::recv(datagrams_, bytes, sizeof bytes, 0);
        for (const auto& frame : tether::mavlink::Decoder().push_datagram(
                 {bytes, static_cast<std::size_t>(std::max<ssize_t>(size, 0))}))
          on_companion(frame);
      }
      if (is_idle || waits[1].revents != 0) look();
      if (waits[0].revents == 0) continue;
      const ssize_t size = ::recv(stream_, bytes, sizeof bytes, 0);
      if (size <= 0) std::_Exit(0);
      for (const auto& frame : decoder_.push({bytes, static_cast<std::size_t>(size)}))
        on_simulator(frame.message);
    }
  }

 private:
  void sense(const Message& m) {
    FakeState& s = flight_.state;
    const double now_s = static_cast<double>(m.integer("time_usec")) * 1e-6;
    const double dt = std::clamp(now_s - s.now_s, 0.0, 0.01);
    s.now_s = now_s;
    s.w = {m.number("xgyro"), m.number("ygyro"), m.number("zgyro")};
    const Vec3 force{m.number("xacc"), m.number("yacc"), m.number("zacc")};
    if (!flight_.is_armed) {  // it stands, and looks where north is
      s.q = yaw_of(m);
      s.v = {};
      return;
    }
    s.q = normalized(s.q *
                     normalized(Quat{1.0, 0.5 * dt * s.w.x, 0.5 * dt * s.w.y, 0.5 * dt * s.w.z}));
    s.v = s.v + dt * (rotate(s.q, force) + Vec3{0.0, 0.0, FakeFlight::kGravity});
    s.p = s.p + dt * s.v;
  }

  void fix(const Message& m) {
    constexpr double kMetresOfDegree = 111'200.0;
    const double lat = m.number("lat") * 1e-7, lon = m.number("lon") * 1e-7;
    const Vec3 at{lat * kMetresOfDegree,
                  lon * kMetresOfDegree * std::cos(lat * std::acos(-1.0) / 180.0),
                  -m.number("alt") * 1e-3};
    if (!flight_.is_armed) origin_ = at;
    flight_.state.p = at - origin_;
    flight_.state.v = {m.number("vn") * 0.01, m.number("ve") * 0.01, m.number("vd") * 0.01};
  }

  void on_simulator(const Message& m) {
    if (m.is("HIL_GPS")) fix(m);
    if (!m.is("HIL_SENSOR")) return;
    sense(m);
    const double now_s = flight_.state.now_s;
    if (now_s > parameter("FAKE_END", INFINITY)) {
      std::printf("ERROR [fake] the end that was asked for\n");
      std::exit(7);
    }
    while (now_s > parameter("FAKE_SPIN", INFINITY)) {
    }
    if (now_s < kBoot_s) return;
    Message controls("HIL_ACTUATOR_CONTROLS");
    const auto shares = flight_.shares();
    controls.set("time_usec", m.integer("time_usec")).set("flags", 1);
    controls.set("mode", flight_.is_armed ? 129 : 1);
    for (std::size_t i = 0; i < shares.size(); ++i) controls.set("controls", shares[i], i);
    const auto frame = tether::mavlink::encode(controls, {1, 1}, sequence_++);
    (void)!::send(stream_, frame.data(), frame.size(), MSG_NOSIGNAL);
    flight_.telemetry();
  }

  void on_companion(const tether::mavlink::Frame& frame) {
    const Message& m = frame.message;
    if (m.is("TIMESYNC"))
      flight_.tell(Message("TIMESYNC").set("tc1", 1).set("ts1", m.integer("ts1")));
    flight_.on_companion(frame, static_cast<std::uint32_t>(parameter("FAKE_VERSION", 0x011000ff)));
  }

  void look() {
    if (flight_.state.now_s < current_due_s_) return;
    current_due_s_ += 1.0;
    flight_.tell(Message("MISSION_CURRENT"));
  }

  void tell(const Message& message, tether::mavlink::Address from) {
    const auto frame = tether::mavlink::encode(message, from, sequence_++);
    ::sendto(datagrams_, frame.data(), frame.size(), 0, reinterpret_cast<const sockaddr*>(&remote_),
             sizeof remote_);
  }

  sockaddr_in remote_;
  int stream_ = -1, datagrams_ = -1;
  tether::mavlink::Decoder decoder_;
  std::uint8_t sequence_ = 0;
  double current_due_s_ = kBoot_s + 0.5;
  Vec3 origin_;
  FakeFlight flight_{rotors(), parameter("MPC_THR_HOVER"),
                     [this](const Message& m, tether::mavlink::Address from) { tell(m, from); }};
};

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  FakePx4(argc > 3 ? std::atoi(argv[3]) : 0).run();
}

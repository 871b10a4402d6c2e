// A peer for tests that behaves at its ports as PX4 in the loop does, as far as the flights need:
// fake_px4 -d -i INSTANCE FOLDER
//
// It connects to TCP 4560 + INSTANCE. Its clock is HIL_SENSOR. In the first two seconds of that, it
// boots, and sends no actuators. Then it listens at UDP 14580 + INSTANCE; what comes there, it
// takes and acknowledges at once, in real time, whether its clock goes on or not. It flies:
// attitude from the gyroscopes, position from HIL_GPS and the accelerometers, and rotors where its
// parameters (PX4_PARAM_CA_ROTOR…) say they are. PX4_PARAM_FAKE_END = N: it exits with code 7 after
// N s of its time; PX4_PARAM_FAKE_SPIN = N: it computes without end from then on.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/mavlink/frame.h>
#include <tether/uav/math.h>

namespace {

using tether::mavlink::Message;
using tether::uav::Quat;
using tether::uav::Vec3;

constexpr double kGravity = 9.81, kBoot_s = 2.0;

double parameter(const std::string& name, double otherwise = 0.0) {
  const char* const value = std::getenv(("PX4_PARAM_" + name).c_str());
  return value == nullptr ? otherwise : std::atof(value);
}

sockaddr_in local(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// Flies in NED and FRD, from its sensors alone.
class Pilot {
 public:
  void sense(const Message& m) {
    const double now_s = static_cast<double>(m.integer("time_usec")) * 1e-6;
    const double dt = std::clamp(now_s - now_s_, 0.0, 0.01);
    now_s_ = now_s;
    w_ = {m.number("xgyro"), m.number("ygyro"), m.number("zgyro")};
    const Vec3 force{m.number("xacc"), m.number("yacc"), m.number("zacc")};
    if (!is_armed) {  // it stands, and looks where north is
      q_ = yaw_of(m);
      v_ = {};
      return;
    }
    q_ = normalized(q_ * normalized(Quat{1.0, 0.5 * dt * w_.x, 0.5 * dt * w_.y, 0.5 * dt * w_.z}));
    const Vec3 a = rotate(q_, force) + Vec3{0.0, 0.0, kGravity};
    v_ = v_ + dt * a;
    p = p + dt * v_;
  }
  void fix(const Message& m) {
    constexpr double kMetresOfDegree = 111'200.0;
    const double lat = m.number("lat") * 1e-7, lon = m.number("lon") * 1e-7;
    const Vec3 at{lat * kMetresOfDegree,
                  lon * kMetresOfDegree * std::cos(lat * std::acos(-1.0) / 180.0),
                  -m.number("alt") * 1e-3};
    if (!is_armed) origin_ = at;
    p = at - origin_;
    v_ = {m.number("vn") * 0.01, m.number("ve") * 0.01, m.number("vd") * 0.01};
  }

  std::vector<double> shares() {
    const int rotors = static_cast<int>(parameter("CA_ROTOR_COUNT"));
    std::vector<double> shares;
    if (!is_armed) return std::vector<double>(16, 0.0);
    Vec3 a = 4.0 * (goal - p) - 3.0 * v_;
    a.x = std::clamp(a.x, -2.5, 2.5);
    a.y = std::clamp(a.y, -2.5, 2.5);
    a.z = std::clamp(a.z, -3.0, 3.0);
    const Vec3 up_B = rotate(inverse(q_), (1.0 / kGravity) * (a - Vec3{0.0, 0.0, kGravity}));
    const Vec3 turn{60.0 * up_B.y - 15.0 * w_.x, -60.0 * up_B.x - 15.0 * w_.y, -2.0 * w_.z};
    for (int i = 0; i < rotors; ++i) {
      const std::string rotor = "CA_ROTOR" + std::to_string(i) + "_";
      const double x = parameter(rotor + "PX"), y = parameter(rotor + "PY");
      const double spin = parameter(rotor + "KM") > 0.0 ? 1.0 : -1.0;
      const double thrust = -up_B.z - 0.12 * y * turn.x + 0.12 * x * turn.y + 0.05 * spin * turn.z;
      shares.push_back(std::sqrt(std::max(0.0, thrust * parameter("MPC_THR_HOVER"))));
    }
    shares.resize(16);
    return shares;
  }

  double now_s() const { return now_s_; }
  bool is_landed() const { return !is_armed; }
  Vec3 p;  ///< from where it was armed
  Vec3 goal;
  bool is_armed = false;

 private:
  // Standing level, the compass points to magnetic north; the world's field points where it points.
  static Quat yaw_of(const Message& m) {
    constexpr double kDeclination_rad = 0.2555;  // of (6, 23) µT east and north
    const double yaw = std::atan2(-m.number("ymag"), m.number("xmag")) + kDeclination_rad;
    return {std::cos(yaw / 2), 0.0, 0.0, std::sin(yaw / 2)};
  }

  double now_s_ = 0.0;
  Quat q_;
  Vec3 v_, w_, origin_;
};

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
    ::bind(datagrams_, reinterpret_cast<const sockaddr*>(&own), sizeof own);
  }

  [[noreturn]] void run() {
    std::uint8_t bytes[65536];
    for (;;) {
      pollfd waits[2] = {{stream_, POLLIN, 0}, {datagrams_, POLLIN, 0}};
      ::poll(waits, 2, -1);
      if (waits[1].revents != 0) {
        const ssize_t size = ::recv(datagrams_, bytes, sizeof bytes, 0);
        for (const auto& frame : tether::mavlink::Decoder().push_datagram(
                 {bytes, static_cast<std::size_t>(std::max<ssize_t>(size, 0))}))
          on_companion(frame);
      }
      if (waits[0].revents == 0) continue;
      const ssize_t size = ::recv(stream_, bytes, sizeof bytes, 0);
      if (size <= 0) std::_Exit(0);
      for (const auto& frame : decoder_.push({bytes, static_cast<std::size_t>(size)}))
        on_simulator(frame.message);
    }
  }

 private:
  void on_simulator(const Message& m) {
    if (m.is("HIL_GPS")) pilot_.fix(m);
    if (!m.is("HIL_SENSOR")) return;
    pilot_.sense(m);
    if (pilot_.now_s() > parameter("FAKE_END", INFINITY)) {
      std::printf("ERROR [fake] the end that was asked for\n");
      std::exit(7);
    }
    while (pilot_.now_s() > parameter("FAKE_SPIN", INFINITY)) {
    }
    if (pilot_.now_s() < kBoot_s) return;
    // NAV_LAND: down, until it is not going down any more.
    if (is_landing_) {
      pilot_.goal.z = pilot_.p.z + 0.3;
      if (pilot_.p.z > -0.02) pilot_.is_armed = is_landing_ = false;
    }
    Message controls("HIL_ACTUATOR_CONTROLS");
    controls.set("time_usec", m.integer("time_usec")).set("flags", 1);
    controls.set("mode", pilot_.is_armed ? 129 : 1);
    const auto shares = pilot_.shares();
    for (std::size_t i = 0; i < shares.size(); ++i) controls.set("controls", shares[i], i);
    const auto frame = tether::mavlink::encode(controls, kSelf, sequence_++);
    (void)!::send(stream_, frame.data(), frame.size(), MSG_NOSIGNAL);
    telemetry();
  }

  void telemetry() {
    if (++steps_ % 8 == 0)
      tell(Message("LOCAL_POSITION_NED")
               .set("time_boot_ms", static_cast<std::int64_t>(pilot_.now_s() * 1e3))
               .set("x", pilot_.p.x)
               .set("y", pilot_.p.y)
               .set("z", pilot_.p.z));
    if (steps_ % 250 != 0) return;
    tell(Message("HEARTBEAT")
             .set("type", 2)
             .set("autopilot", 12)
             .set("base_mode", pilot_.is_armed ? 129 : 1)
             .set("mavlink_version", 3));
    tell(Message("EXTENDED_SYS_STATE").set("landed_state", pilot_.is_landed() ? 1 : 2));
  }

  void on_companion(const tether::mavlink::Frame& frame) {
    constexpr int kArm = 400, kTakeOff = 22, kLand = 21, kRequest = 512;
    const Message& m = frame.message;
    if (m.is("TIMESYNC")) tell(Message("TIMESYNC").set("tc1", 1).set("ts1", m.integer("ts1")));
    if (m.is("SET_POSITION_TARGET_LOCAL_NED") && !is_landing_)
      pilot_.goal = {m.number("x"), m.number("y"), m.number("z")};
    if (!m.is("COMMAND_LONG")) return;
    const auto command = m.integer("command");
    if (command == kArm) pilot_.is_armed = m.number("param1") > 0.5;
    if (command == kArm) pilot_.goal = pilot_.p = {};
    if (command == kTakeOff) pilot_.goal.z = -1.5;
    if (command == kLand) is_landing_ = true;
    if (command == kRequest)
      tell(Message("AUTOPILOT_VERSION").set("flight_sw_version", 0x011000ff));
    tell(Message("COMMAND_ACK").set("command", command).set("target_system", frame.from.system));
  }

  void tell(const Message& message) {
    const auto frame = tether::mavlink::encode(message, kSelf, sequence_++);
    ::sendto(datagrams_, frame.data(), frame.size(), 0, reinterpret_cast<const sockaddr*>(&remote_),
             sizeof remote_);
  }

  static constexpr tether::mavlink::Address kSelf{.system = 1, .component = 1};
  sockaddr_in remote_;
  int stream_ = -1, datagrams_ = -1;
  tether::mavlink::Decoder decoder_;
  std::uint8_t sequence_ = 0;
  std::uint64_t steps_ = 0;
  bool is_landing_ = false;
  Pilot pilot_;
};

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  FakePx4(argc > 3 ? std::atoi(argv[3]) : 0).run();
}

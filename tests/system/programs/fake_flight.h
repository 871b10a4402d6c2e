#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <tether/mavlink/frame.h>
#include <tether/uav/math.h>

/// What peers of tests that stand for flight controllers have in common: how they fly, and how they
/// talk to a companion.
namespace tether::system_test {

inline sockaddr_in local(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// In NED and FRD.
struct FakeState {
  double now_s = 0.0;
  uav::Quat q;
  uav::Vec3 p, v, w;  ///< p: from where it was armed
};

struct FakeRotor {
  double x = 0.0, y = 0.0;  ///< ahead, to the right
  double spin = 1.0;        ///< counter-clockwise from above: 1, else -1
};

class FakeFlight {
 public:
  static constexpr double kGravity = 9.81;

  /// `hover` is the share of the thrust that hovers; `tell` sends a message to the companion.
  FakeFlight(std::vector<FakeRotor> rotors, double hover,
             std::function<void(const mavlink::Message&, mavlink::Address)> tell)
      : rotors_(std::move(rotors)), hover_(hover), tell_(std::move(tell)) {}

  FakeState state;
  uav::Vec3 goal;
  bool is_armed = false;

  /// Of the rotors' largest speed.
  std::vector<double> shares() {
    // NAV_LAND: down, until it is not going down any more.
    if (is_landing_) {
      goal.z = state.p.z + 0.3;
      if (state.p.z > -0.02) is_armed = is_landing_ = false;
    }
    std::vector<double> shares;
    if (!is_armed) return std::vector<double>(rotors_.size(), 0.0);
    uav::Vec3 a = 4.0 * (goal - state.p) - 3.0 * state.v;
    a.x = std::clamp(a.x, -2.5, 2.5);
    a.y = std::clamp(a.y, -2.5, 2.5);
    a.z = std::clamp(a.z, -3.0, 3.0);
    const uav::Vec3 up_B =
        rotate(inverse(state.q), (1.0 / kGravity) * (a - uav::Vec3{0.0, 0.0, kGravity}));
    const uav::Vec3& w = state.w;
    const uav::Vec3 turn{60.0 * up_B.y - 15.0 * w.x, -60.0 * up_B.x - 15.0 * w.y, -2.0 * w.z};
    for (const FakeRotor& rotor : rotors_) {
      const double thrust =
          -up_B.z - 0.12 * rotor.y * turn.x + 0.12 * rotor.x * turn.y + 0.05 * rotor.spin * turn.z;
      shares.push_back(std::sqrt(std::max(0.0, thrust * hover_)));
    }
    return shares;
  }

  /// Sends what is due since the last call.
  void telemetry() {
    const auto due = [&](double period_s) {
      return std::floor(state.now_s / period_s) != std::floor(told_s_ / period_s);
    };
    if (due(0.032))
      tell(mavlink::Message("LOCAL_POSITION_NED")
               .set("time_boot_ms", static_cast<std::int64_t>(state.now_s * 1e3))
               .set("x", state.p.x)
               .set("y", state.p.y)
               .set("z", state.p.z));
    if (due(1.0)) {
      tell(mavlink::Message("HEARTBEAT")
               .set("type", 2)
               .set("autopilot", 12)
               .set("base_mode", is_armed ? 129 : 1)
               .set("mavlink_version", 3));
      tell(mavlink::Message("EXTENDED_SYS_STATE").set("landed_state", is_armed ? 2 : 1));
    }
    told_s_ = state.now_s;
  }

  /// `version` 0: it does not tell it. `on_request` answers MAV_CMD_REQUEST_MESSAGE for messages
  /// but AUTOPILOT_VERSION.
  void on_companion(const mavlink::Frame& frame, std::uint32_t version,
                    const std::function<void(int)>& on_request = {}) {
    constexpr int kArm = 400, kTakeOff = 22, kLand = 21, kRequest = 512, kVersion = 148;
    const mavlink::Message& m = frame.message;
    if (m.is("SET_POSITION_TARGET_LOCAL_NED") && !is_landing_)
      goal = {m.number("x"), m.number("y"), m.number("z")};
    if (!m.is("COMMAND_LONG")) return;
    const auto command = m.integer("command");
    if (command == kArm) is_armed = m.number("param1") > 0.5;
    if (command == kArm) goal = state.p = {};
    if (command == kTakeOff) goal.z = -1.5;
    if (command == kLand) is_landing_ = true;
    const auto wanted = static_cast<int>(m.number("param1"));
    if (command == kRequest && wanted == kVersion && version == 0) return;
    if (command == kRequest && wanted == kVersion)
      tell(mavlink::Message("AUTOPILOT_VERSION").set("flight_sw_version", version));
    else if (command == kRequest && on_request)
      on_request(wanted);
    tell(mavlink::Message("COMMAND_ACK")
             .set("command", command)
             .set("target_system", frame.from.system));
  }

  void tell(const mavlink::Message& message) const {
    tell_(message, {.system = 1, .component = 1});
  }

 private:
  std::vector<FakeRotor> rotors_;
  double hover_;
  std::function<void(const mavlink::Message&, mavlink::Address)> tell_;
  bool is_landing_ = false;
  double told_s_ = 0.0;
};

}  // namespace tether::system_test

#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>
#include <tether/uav/multirotor.h>

namespace tether::autopilot {

using mavlink::Message;

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN(),
                        kInfinite = std::numeric_limits<double>::infinity();
inline constexpr long kAccepted = 0, kRejected = 1, kDenied = 2, kUnsupported = 3, kFailed = 4;
inline constexpr int kArmCommand = 400, kTakeOffCommand = 22, kLandCommand = 21,
                     kReturnCommand = 20, kSetMode = 176;
inline constexpr int kPositionOnly = 0x0DF8, kVelocityOnly = 0x0DC7;

/// A vehicle over flat ground at z = 0 with the built-in controller, and its companion.
class Flight {
 public:
  explicit Flight(BuiltInSettings settings = {}, uav::Vec3 p_WB = {}, double yaw_rad = 0.0,
                  double heading_rad = 0.0)
      : multirotor_(uav::hummingbird(), kGravity, std::chrono::milliseconds(1)),
        state_(hover_state(uav::hummingbird(), kGravity, yaw_rad)) {
    settings.place = {
        .latitude_deg = 0.0, .longitude_deg = 0.0, .elevation_m = 0.0, .heading_rad = heading_rad};
    std::vector<uav::Joint> joints = std::move(settings.limits.joints);
    settings.limits = flight_limits(uav::hummingbird());
    settings.limits.joints = std::move(joints);
    settings.hover_thrust_N = uav::hummingbird().mass_kg * kGravity;
    limits_ = settings.limits;
    controller_ = make_built_in(settings);
    body.p_WB = p_WB;
    body.q_WB = uav::from_rpy(0, 0, yaw_rad);
  }

  static BuiltInSettings in_air(std::map<std::string, double> parameters = {}) {
    return {.starts_in_air = true, .parameters = std::move(parameters)};
  }

  void send(const Message& message, mavlink::Address from = {1, 191}) {
    outgoing_.push_back(encode(message, from, sequence_++));
  }
  void send_bytes(Bytes bytes) { outgoing_.push_back(std::move(bytes)); }

  /// So many seconds; `each`: before each step of the controller, which is every 4 ms.
  void run(double seconds, const std::function<void()>& each = {}) {
    const SimTime until = now + duration_from_seconds(seconds);
    while (now < until) {
      if (each) each();
      step();
    }
  }
  /// At most so long, until it is so.
  bool run_until(const std::function<bool()>& is_so, double most_s = 120.0) {
    const SimTime until = now + duration_from_seconds(most_s);
    while (now < until && !is_so()) step();
    return is_so();
  }
  /// Sends it so many times a second.
  void stream(const Message& message, double seconds, double rate_hz = 20.0) {
    SimTime next = now;
    run(seconds, [&] {
      if (now < next) return;
      send(message);
      next += duration_from_seconds(1.0 / rate_hz);
    });
  }

  /// The result of a command: its acknowledgement.
  long command(int id, std::initializer_list<double> parameters = {}, int system = 1) {
    Message m("COMMAND_LONG");
    m.set("target_system", system).set("target_component", 1).set("command", id);
    for (std::size_t i = 1; i <= 7; ++i) m.set("param" + std::to_string(i), i > 4 ? kNone : 0.0);
    std::size_t i = 0;
    for (const double parameter : parameters) m.set("param" + std::to_string(++i), parameter);
    return acknowledged(m);
  }
  long acknowledged(const Message& message) {
    heard.clear();
    send(message);
    step();
    const Message* ack = last("COMMAND_ACK");
    return ack == nullptr ? -1 : static_cast<long>(ack->integer("result"));
  }
  long mode(int main, int sub = 0) {
    return command(kSetMode, {1, static_cast<double>(main), static_cast<double>(sub)});
  }
  /// Boots, arms, takes off to 2.5 m and holds.
  void take_off() {
    boot();
    ASSERT_EQ(command(kArmCommand, {1}), kAccepted);
    ASSERT_EQ(command(kTakeOffCommand), kAccepted);
    ASSERT_TRUE(run_until([&] { return shown_mode() == "AUTO.LOITER"; }, 10.0));
  }
  void boot() { run(1.0); }

  const Message* last(std::string_view name) const {
    const Message* found = nullptr;
    for (const Message& message : heard)
      if (message.is(name)) found = &message;
    return found;
  }
  std::size_t count(std::string_view name) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(heard, [&](const Message& m) { return m.is(name); }));
  }
  /// Whether a line for the user had this text.
  bool was_said(std::string_view text) const {
    std::string all;
    for (const Message& m : heard)
      if (m.is("STATUSTEXT")) all += (m.integer("chunk_seq") == 0 ? "\n" : "") + m.text("text");
    return all.find(text) != std::string::npos;
  }
  bool is_armed() const { return (base_mode_ & 128) != 0; }
  std::string shown_mode() const {
    const std::map<unsigned, std::string> names{{3 << 16, "POSCTL"},
                                                {2 << 24 | 4 << 16, "AUTO.TAKEOFF"},
                                                {3 << 24 | 4 << 16, "AUTO.LOITER"},
                                                {4 << 24 | 4 << 16, "AUTO.MISSION"},
                                                {5 << 24 | 4 << 16, "AUTO.RTL"},
                                                {6 << 24 | 4 << 16, "AUTO.LAND"},
                                                {6 << 16, "OFFBOARD"}};
    return names.contains(custom_mode_) ? names.at(custom_mode_) : "none";
  }
  double yaw() const { return uav::yaw_rad(body.q_WB); }
  double tilt() const { return std::acos(rotate(body.q_WB, {0, 0, 1}).z); }

  static constexpr double kGravity = 9.81;
  SimTime now{};
  uav::BodyState body;
  std::optional<double> charge;  ///< of a battery
  uav::Vec3 drift_m, drift_m_s;  ///< of an odometry; none if it is not `has_odometry`
  double drift_rad = 0.0;        ///< its yaw, likewise
  bool has_odometry = false;
  bool is_on_rope = false;     ///< does not move
  uav::Vec3 carried_m_s;       ///< what it stands on moves
  uav::Setpoint setpoint;      ///< what it follows
  std::size_t refused = 0;     ///< messages that it did not take
  std::vector<Message> heard;  ///< from the controller

 private:
  void step() {
    Sensed sensed{.at = now, .truth = body};
    if (charge)
      sensed.battery = uav::BatterySample{
          .sampled_at = now, .voltage_V = 15.2, .current_A = 8.0, .charge = *charge};
    if (has_odometry) {
      sensed.measure = [&](uav::SensorKind kind) -> std::optional<uav::Sample> {
        if (kind != uav::SensorKind::kOdometry) return std::nullopt;
        uav::OdometrySample sample;
        sample.sampled_at = now;
        sample.p_WS = body.p_WB + drift_m;
        sample.q_WS = uav::from_axis_angle({0, 0, 1}, drift_rad) * body.q_WB;
        sample.v_WS_m_s = body.v_WB + drift_m_s;
        sample.w_WS_rad_s = body.w_WB_B;
        return sample;
      };
    }
    Actions actions = controller_->step(sensed, std::exchange(outgoing_, {}));
    for (const Bytes& bytes : actions.sent)
      for (const mavlink::Frame& frame : decoder_.push(bytes)) hear(frame);
    if (actions.setpoint) setpoint = *actions.setpoint;
    refused += actions.refused.size();
    EXPECT_EQ(complaint_about(setpoint, limits_), "");
    for (int i = 0; i < 4; ++i) integrate();
    now += std::chrono::milliseconds(4);
  }

  void hear(const mavlink::Frame& frame) {
    EXPECT_EQ(frame.from, (mavlink::Address{1, 1}));
    EXPECT_EQ(frame.sequence, expected_++);
    if (frame.message.is("HEARTBEAT")) {
      base_mode_ = frame.message.integer("base_mode");
      custom_mode_ = static_cast<unsigned>(frame.message.integer("custom_mode"));
    }
    heard.push_back(frame.message);
  }

  void integrate() {
    constexpr double kDt_s = 1e-3;
    const uav::MultirotorParameters& p = multirotor_.parameters();
    const uav::Wrench wrench = multirotor_.step(body, setpoint, state_);
    if (is_on_rope) return;
    drift_m = drift_m + kDt_s * drift_m_s;
    body.v_WB = body.v_WB + (kDt_s / p.mass_kg) * rotate(body.q_WB, wrench.force_B) -
                uav::Vec3{0, 0, kGravity * kDt_s};
    const uav::Vec3 &w = body.w_WB_B, &inertia = p.inertia_kg_m2;
    const uav::Vec3 torque =
        wrench.torque_B - cross(w, {inertia.x * w.x, inertia.y * w.y, inertia.z * w.z});
    body.w_WB_B =
        w + kDt_s * uav::Vec3{torque.x / inertia.x, torque.y / inertia.y, torque.z / inertia.z};
    if (body.p_WB.z <= 0.0 && body.v_WB.z < 0.0) {  // it stands
      body.v_WB = carried_m_s;
      body.w_WB_B = {};
      body.q_WB = uav::from_rpy(0, 0, yaw());
      body.p_WB.z = 0.0;
    }
    body.p_WB = body.p_WB + kDt_s * body.v_WB;
    const double rate = norm(body.w_WB_B);
    if (rate > 0.0)
      body.q_WB = uav::normalized(body.q_WB *
                                  uav::from_axis_angle((1.0 / rate) * body.w_WB_B, rate * kDt_s));
  }

  uav::Multirotor multirotor_;
  uav::MultirotorState state_;
  std::unique_ptr<FlightController> controller_;
  uav::FlightLimits limits_;
  std::vector<Bytes> outgoing_;
  mavlink::Decoder decoder_;
  std::uint8_t sequence_ = 0, expected_ = 0;
  std::int64_t base_mode_ = 0;
  unsigned custom_mode_ = 0;
};

/// SET_POSITION_TARGET_LOCAL_NED, to the controller; x, y, z and so on are set by the caller.
inline Message target(int mask, int frame = 1) {
  return Message("SET_POSITION_TARGET_LOCAL_NED")
      .set("target_system", 1)
      .set("target_component", 1)
      .set("coordinate_frame", frame)
      .set("type_mask", mask);
}
inline Message position_target(double x, double y, double z) {
  return target(kPositionOnly).set("x", x).set("y", y).set("z", z);
}

}  // namespace tether::autopilot

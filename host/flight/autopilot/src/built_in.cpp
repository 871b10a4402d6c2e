// One step: the estimate, then what the companion has sent, in order, then what time brings
// (Commander), then where to go (Navigator), then telemetry. All parts share one Vehicle.

#include "commander.h"
#include "missions.h"
#include "navigator.h"
#include "offboard.h"
#include "outbox.h"
#include "set_down.h"
#include "telemetry.h"
#include "vehicle.h"

#include <cstring>
#include <utility>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

// PX4 sends the bytes of an integer as those of a float.
double float_of_bytes(std::int32_t value) {
  float as_float = 0.0F;
  std::memcpy(&as_float, &value, sizeof value);
  return as_float;
}
std::int32_t bytes_of_float(double value) {
  const auto as_float = static_cast<float>(value);
  std::int32_t bytes = 0;
  std::memcpy(&bytes, &as_float, sizeof bytes);
  return bytes;
}

/// The parameter protocol (mavlink.io/en/services/parameter.html).
class ParameterPort {
 public:
  static bool takes(const mavlink::Message& message) {
    return message.name().starts_with("PARAM_");
  }

  void on_message(const mavlink::Message& m, Parameters& parameters, Outbox& outbox) {
    if (m.is("PARAM_REQUEST_LIST")) next_ = 0;
    if (m.is("PARAM_REQUEST_READ")) {
      const auto asked = m.integer("param_index");
      const auto index = asked < 0 ? find_parameter(m.text("param_id"))
                                   : std::optional(static_cast<std::size_t>(asked));
      if (index && *index < parameter_infos().size()) send(*index, parameters, outbox);
    }
    if (!m.is("PARAM_SET")) return;
    const auto index = find_parameter(m.text("param_id"));
    if (!index) return outbox.say(4, "parameter not set: unknown " + printable(m.text("param_id")));
    const double value = m.number("param_value");
    const bool is_integer = parameter_infos()[*index].is_integer;
    if (m.integer("param_type") == (is_integer ? kInt32 : kReal32))
      parameters.set(*index, is_integer ? bytes_of_float(value) : value);
    else
      outbox.say(4, "parameter not set: its type is another one");
    send(*index, parameters, outbox);
  }

  /// A list is sent one at a step.
  void step(const Parameters& parameters, Outbox& outbox) {
    if (next_ >= parameter_infos().size()) return;
    send(next_++, parameters, outbox);
  }

 private:
  static constexpr int kInt32 = 6, kReal32 = 9;  // MAV_PARAM_TYPE

  static void send(std::size_t index, const Parameters& parameters, Outbox& outbox) {
    const ParameterInfo& info = parameter_infos()[index];
    const double value = parameters.value(index);
    mavlink::Message m("PARAM_VALUE");
    m.set_text("param_id", info.name)
        .set("param_value",
             info.is_integer ? float_of_bytes(static_cast<std::int32_t>(value)) : value)
        .set("param_type", info.is_integer ? kInt32 : kReal32)
        .set("param_count", parameter_infos().size())
        .set("param_index", index);
    outbox.send(m);
  }

  std::size_t next_ = static_cast<std::size_t>(-1);
};

class BuiltIn : public FlightController {
 public:
  explicit BuiltIn(const BuiltInSettings& settings)
      : settings_(settings),
        vehicle_(Parameters(settings.parameters)),
        telemetry_(settings.link_baud),
        outbox_({settings.system_id, kAutopilot}),
        commander_(vehicle_, navigator_, missions_, offboard_, telemetry_, outbox_) {
    vehicle_.limits = settings.limits;
    vehicle_.mount = Mount(settings.limits.joints);
    vehicle_.hover_thrust_N = settings.hover_thrust_N;
  }

  Actions step(const Sensed& sensed, const std::vector<Bytes>& received) override {
    const Duration since = has_begun_ ? sensed.at - vehicle_.now : kBuiltInPeriod;
    estimate(sensed);
    if (!has_begun_ && !settings_.starts_in_air && !set_down_.is_done(sensed.at, sensed.truth))
      return {.setpoint = SetDown::setpoint(), .sent = {}};
    if (!std::exchange(has_begun_, true)) begin();
    std::vector<Actions::Refusal> ignored;
    for (std::size_t i = 0; i < received.size(); ++i) {
      bool is_taken = true;
      for (const mavlink::Frame& frame : decoder_.push_datagram(received[i]))
        is_taken = on_frame(frame) && is_taken;
      if (!is_taken) ignored.push_back({i, "ignored"});
    }
    commander_.step();
    missions_.step(vehicle_.now, outbox_);
    parameter_port_.step(vehicle_.parameters, outbox_);
    uav::Setpoint wanted = navigator_.step(vehicle_, missions_, offboard_, since, outbox_);
    vehicle_.mount.add_to(wanted);
    telemetry_.step({vehicle_, sensed, wanted, missions_}, outbox_);
    return {.setpoint = of_truth(wanted, sensed.truth),
            .sent = outbox_.take(),
            .refused = std::move(ignored)};
  }

 private:
  void estimate(const Sensed& sensed) {
    vehicle_.now = sensed.at;
    vehicle_.battery = sensed.battery;
    vehicle_.estimate = sensed.truth;
    const auto sample = sensed.measure ? sensed.measure(uav::SensorKind::kOdometry) : std::nullopt;
    if (!sample) return;
    vehicle_.odometry = std::get<uav::OdometrySample>(*sample);
    vehicle_.estimate = {vehicle_.odometry->p_WS, vehicle_.odometry->q_WS,
                         vehicle_.odometry->v_WS_m_s, vehicle_.odometry->w_WS_rad_s};
  }

  void begin() {
    vehicle_.frame = LocalFrame(settings_.place, vehicle_.estimate.p_WB);
    vehicle_.home_W = vehicle_.estimate.p_WB;
    vehicle_.home_yaw_W_rad = uav::yaw_rad(vehicle_.estimate.q_WB);
    vehicle_.is_armed = settings_.starts_in_air;
    vehicle_.is_landed = !settings_.starts_in_air;
    navigator_.begin(vehicle_, missions_);
  }

  // To this system, or to all; to the autopilot, or to all components.
  bool is_for_us(const mavlink::Message& m) const {
    const auto* system = m.type().field("target_system");
    if (system == nullptr) return true;
    const auto wanted = m.integer("target_system");
    if (wanted != 0 && wanted != settings_.system_id) return false;
    if (m.type().field("target_component") == nullptr) return true;
    const auto component = m.integer("target_component");
    return component == 0 || component == kAutopilot;
  }

  /// False: it is a set-point that is not flown, whatever the mode.
  bool on_frame(const mavlink::Frame& frame) {
    const mavlink::Message& m = frame.message;
    if (Offboard::takes(m)) {
      if (!is_for_us(m)) return false;
      const std::string wrong = offboard_.on_message(m, vehicle_);
      if (wrong != std::exchange(last_complaint_, wrong) && !wrong.empty()) outbox_.say(4, wrong);
      return wrong.empty();
    }
    if (is_for_us(m)) on_other(frame);
    return true;
  }

  void on_other(const mavlink::Frame& frame) {
    const mavlink::Message& m = frame.message;
    if (Commander::takes(m)) return commander_.on_message(frame);
    if (Missions::takes(m)) return missions_.on_message(frame, vehicle_, outbox_);
    if (ParameterPort::takes(m)) return parameter_port_.on_message(m, vehicle_.parameters, outbox_);
    if (m.is("TIMESYNC") && m.integer("tc1") == 0)
      outbox_.send(mavlink::Message("TIMESYNC")
                       .set("tc1", to_ns(vehicle_.now))
                       .set("ts1", m.integer("ts1")));
    if (m.is("PING") && m.integer("target_system") == 0) {
      mavlink::Message answer = m;
      answer.set("target_system", frame.from.system).set("target_component", frame.from.component);
      outbox_.send(answer);
    }
  }

  // The cascade flies on the truth. A set-point that is moved by the estimate's error brings the
  // estimate to where it should be.
  uav::Setpoint of_truth(uav::Setpoint wanted, const uav::BodyState& truth) const {
    if (!vehicle_.odometry) return wanted;
    const uav::BodyState& estimate = vehicle_.estimate;
    wanted.p_WB_m = wanted.p_WB_m + truth.p_WB - estimate.p_WB;
    if (wanted.has(uav::kVelocity) && !wanted.has(uav::kPosition))
      wanted.velocity_m_s = wanted.velocity_m_s + truth.v_WB - estimate.v_WB;
    wanted.yaw_rad += uav::yaw_rad(truth.q_WB) - uav::yaw_rad(estimate.q_WB);
    if (wanted.has(uav::kAttitude))
      wanted.q_WB = uav::normalized(truth.q_WB * inverse(estimate.q_WB) * wanted.q_WB);
    return wanted;
  }

  BuiltInSettings settings_;
  bool has_begun_ = false;
  SetDown set_down_;  // before it has begun; meanwhile, its controller boots
  Vehicle vehicle_;
  Navigator navigator_;
  Missions missions_;
  Offboard offboard_;
  Telemetry telemetry_;
  Outbox outbox_;
  Commander commander_;
  ParameterPort parameter_port_;
  mavlink::Decoder decoder_;
  std::string last_complaint_;
};

}  // namespace

std::unique_ptr<FlightController> make_built_in(const BuiltInSettings& settings) {
  return std::make_unique<BuiltIn>(settings);
}

}  // namespace tether::autopilot

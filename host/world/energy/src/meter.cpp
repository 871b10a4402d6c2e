#include <algorithm>

#include <tether/energy/meter.h>

namespace tether::energy {
namespace {

double hover_power_W(const Model& model, const uav::MultirotorParameters& airframe,
                     double gravity_m_s2) {
  return propulsion_power_W(airframe, model.propulsion,
                            uav::hover_state(airframe, gravity_m_s2, 0.0), {});
}

}  // namespace

std::string_view name(Cause cause) {
  constexpr std::array<std::string_view, kCauses> kNames = {"lift",      "moving",  "idle",
                                                            "computing", "sensors", "resistance"};
  return kNames[static_cast<std::size_t>(cause)];
}

Meter::Meter(const Model& model, const uav::MultirotorParameters& airframe, double gravity_m_s2)
    : model_(&model), airframe_(&airframe), hover_W_(hover_power_W(model, airframe, gravity_m_s2)) {
  status_.charge = model.battery.initial_charge;
  status_.voltage_V = open_circuit_voltage_V(model.battery, status_.charge);
}

void Meter::step(SimTime from, Duration dt, const uav::BodyState& body,
                 const uav::MultirotorState& rotors) {
  if (status_.empty_at) return;
  const double rotors_W = propulsion_power_W(*airframe_, model_->propulsion, rotors, body);
  const double dt_s = to_seconds(dt);
  std::array<double, kCauses> power_W{};
  const auto of = [&](Cause cause) -> double& { return power_W[static_cast<std::size_t>(cause)]; };
  of(Cause::kLift) = hover_W_;
  of(Cause::kMoving) = rotors_W - hover_W_;
  of(Cause::kIdle) = model_->computer.idle_W;
  of(Cause::kComputing) = model_->computer.busy_core_W * busy_cores_;
  of(Cause::kSensors) = model_->sensors_W;
  double asked_W = 0.0;
  for (const double power : power_W) asked_W += power;

  const Discharge given = discharge(model_->battery, status_.charge, asked_W);
  const double share = asked_W > 0.0 ? given.power_W / asked_W : 0.0;
  for (double& power : power_W) power *= share;
  of(Cause::kResistance) = given.heat_W;
  for (std::size_t i = 0; i < kCauses; ++i) status_.spent_J[i] += power_W[i] * dt_s;

  status_.voltage_V = given.voltage_V;
  status_.current_A = given.current_A;
  status_.charge =
      std::max(0.0, status_.charge - given.current_A * dt_s / model_->battery.capacity_C);
  if (!given.is_exhausted) return;
  status_.empty_at = from + dt;
  status_.current_A = 0.0;
}

double Meter::speed_limit() const {
  if (status_.empty_at) return 0.0;
  return std::min(1.0, status_.voltage_V / model_->propulsion.nominal_voltage_V);
}

}  // namespace tether::energy

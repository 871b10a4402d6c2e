#include <algorithm>

#include <fmt/format.h>

#include <tether/energy/meter.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

[[noreturn]] void fail(const FileLocation& where, const std::string& subject,
                       const std::string& what) {
  throw Error(ErrorCode::kBadFile, where, what).about(subject);
}

/// What only shows together with the airframe.
void require_possible(const Energy& energy, const energy::Model& model, const sim::Uav& uav,
                      double gravity_m_s2) {
  const uav::MultirotorState hover = uav::hover_state(uav.airframe, gravity_m_s2, 0.0);
  const energy::RotorPower power =
      energy::rotor_power(uav.airframe, model.propulsion, hover.rotor_speed_rad_s[0], {});
  if (power.profile_W <= 0.0)
    fail(energy.rotor_at, "rotor",
         fmt::format("the rotor of \"{}\" needs {:.3g} W to hover, which is no more than its "
                     "induced power of {:.3g} W. Raise 'radius_m', lower 'induced_factor', or "
                     "correct the model's moment coefficient.",
                     uav.name, power.total_w(), power.induced_W));
  const double hover_W = energy::propulsion_power_W(uav.airframe, model.propulsion, hover, {});
  const double needed_W = hover_W + model.computer.idle_W + model.sensors_W;
  const energy::Discharge given =
      energy::discharge(model.battery, model.battery.initial_charge, needed_W);
  if (given.is_exhausted)
    fail(energy.battery_at, "battery",
         fmt::format("the battery of \"{}\" cannot lift it: hovering takes {:.4g} W, at which it "
                     "has {:.4g} V with a cut-off of {:.4g} V. Lower the resistance or the "
                     "cut-off, or raise the voltage or the charge.",
                     uav.name, needed_W, given.voltage_V, model.battery.cut_off_V));
}

/// A SUT under tether-exec: its threads may compute while others wait.
bool is_supervised(const Scenario& scenario, const Condition& condition, std::size_t uav) {
  const Sut& sut = scenario.uavs[uav].sut;
  const bool is_wall = computer_of(condition, uav).clock.kind == computer::ClockKind::kWall;
  if (sut.concurrent || (sut.has_all_processes && is_wall)) return true;
  return std::ranges::any_of(
      real_boards(condition, scenario.uavs.size()),
      [uav](const RealBoard& board) { return std::ranges::count(board.uavs, uav) > 0; });
}

}  // namespace

const energy::Computer& power_of(const Scenario& scenario, const Condition& condition,
                                 std::size_t uav) {
  const auto& target = computer_of(condition, uav).target;
  return target && target->power ? *target->power : scenario.uavs[uav].energy->model.computer;
}

void resolve_energy(const Scenario& scenario, const Condition& condition, sim::World& world,
                    const sim::WarningSink& warn) {
  for (std::size_t i = 0; i < scenario.uavs.size(); ++i) {
    if (!scenario.uavs[i].energy) continue;
    const Energy& energy = *scenario.uavs[i].energy;
    sim::Uav& uav = world.uavs[i];
    energy::Model model = energy.model;
    if (!energy.has_battery) {
      if (!uav.battery)
        fail(energy.battery_at, "battery",
             fmt::format("there is no battery for \"{}\". Add a table [battery], or a "
                         "LinearBatteryPlugin to {}.",
                         uav.name, scenario.uavs[i].placement.model.string()));
      model.battery = *uav.battery;
    }
    model.computer = power_of(scenario, condition, i);
    require_possible(energy, model, uav, world.gravity_m_s2);
    if (is_supervised(scenario, condition, i))
      warn({Consequence::kMissing, energy.battery_at, "computing",
            "of a SUT that is concurrent, or shares a real board, is not known; its computer is "
            "charged as idle"});
    uav.energy = std::move(model);
  }
}

}  // namespace tether::scenario

#include "commands/commands.h"
#include "reading/world_options.h"
#include "terminal/print.h"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <tether/os/child_process.h>
#include <tether/os/interrupt.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::app {

namespace {

struct ModelCheckOptions {
  std::filesystem::path model;
  ReadingOptions reading;
};

constexpr double kGravity_m_s2 = 9.8;  // SDF's

/// How it flies, with where that is from.
std::string flight_text(const sim::Uav& uav) {
  const uav::MultirotorParameters& a = uav.airframe;
  const auto rotors = static_cast<double>(a.rotors.size());
  const double weight_N = a.mass_kg * kGravity_m_s2;
  const double hover_rad_s = std::sqrt(weight_N / (rotors * a.thrust_coefficient));
  std::string text = fmt::format(
      "  mass              {:.4g} kg\n"
      "  inertia           {:.3g}, {:.3g}, {:.3g} kg m²\n"
      "  thrust to weight  {:.2f}\n"
      "  hover             at {:.0f} rad/s, {:.0f} % of the rotors' full speed\n"
      "  time constants    {:.4g} s faster, {:.4g} s slower\n",
      a.mass_kg, a.inertia_kg_m2.x, a.inertia_kg_m2.y, a.inertia_kg_m2.z,
      flight_limits(a).max_thrust_N / weight_N, hover_rad_s,
      100.0 * hover_rad_s / a.max_rotor_speed_rad_s, a.time_constant_up_s, a.time_constant_down_s);
  for (const uav::Rotor& rotor : a.rotors)
    text += fmt::format("  rotor             {:.3f} {:.3f} {:.3f} m, {}\n", rotor.p_BR.x,
                        rotor.p_BR.y, rotor.p_BR.z, rotor.direction > 0 ? "ccw" : "cw");
  for (const sim::Sensor& sensor : uav.sensors)
    text += fmt::format("  sensor            {} ({})\n", sensor.name, uav::name(sensor.kind()));
  if (!uav.by_default.empty())
    text += fmt::format("  by default        {}\n", fmt::join(uav.by_default, ", "));
  return text;
}

/// Reads a UAV as a run does, and prints how it flies and what is not simulated as written.
int check_model(const ModelCheckOptions& options, const std::stop_token&) {
  const os::Interrupt::EndsAtOnce reading;
  const auto shipped = scenario::ShippedFiles::of_program(os::own_file());
  std::vector<Warning> warnings;
  const auto file = shipped.find(scenario::ShippedKind::kModel, options.model);
  const sim::Uav uav = sim::load_uav(file, world_options(options.reading, shipped), kGravity_m_s2,
                                     [&](const Warning& warning) { warnings.push_back(warning); });
  print(fmt::format("{}: can fly; its airframe is from {}\n{}{}", file.string(), uav.airframe_from,
                    flight_text(uav), as_written_text(warnings)));
  return 0;
}

Options model_check_rows(ModelCheckOptions& o) {
  return concatenated(
      {{{"model", "Name of a shipped model, or a file (SDF)", &o.model, required()}},
       reading_options(o.reading)});
}

}  // namespace

Command model_check_command() {
  return make_command("model check",
                      "Read a UAV's model, and print how it flies, and from what that follows",
                      model_check_rows,
                      R"(Exit codes: 0 the UAV can fly, 2 it cannot, or wrong use.

Examples:
  tether model check hummingbird
  tether model check x500/model.sdf --tolerant)",
                      check_model);
}

}  // namespace tether::app

#include "tables/read_flight_controller.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <tether/autopilot/built_in.h>

namespace tether::scenario {
namespace {

constexpr std::array<std::string_view, 2> kKinds = {"none", "built-in"};

/// With a flight controller, commands are its own.
void reject_beside_it(const toml::Table& uav) {
  for (const char* key :
       {"command_latency_ms", "command_latency", "setpoint_timeout_ms", "on_setpoint_loss"})
    if (uav.has(key))
      uav.fail(key,
               "has no effect beside 'flight_controller', which has its own link and time-out. "
               "Remove this key; see 'link_latency_ms' and the parameter COM_OF_LOSS_T.");
}

FlightController read_settings(const toml::Table& table, FlightController controller) {
  constexpr toml::Range kBaud{.min = 0.0, .max = 1e9};
  constexpr toml::Range kLatency_ms{.min = 0.0, .max = 10'000.0};
  constexpr toml::Range kValue{.min = -1e9, .max = 1e9};
  controller.link_baud = table.number_or("link_baud", kBaud, 0.0);
  controller.link_latency = table.duration_or("link_latency_ms", kLatency_ms, Duration{0});
  controller.starts_in_air = table.boolean_or("starts_in_air", false);
  if (!table.has("parameters")) return controller;
  const toml::Table parameters = table.table("parameters");
  for (const std::string& name : parameters.keys()) {
    const double value = parameters.number(name, kValue);
    if (const std::string wrong = autopilot::complaint_about_parameter(name, value); !wrong.empty())
      parameters.fail(name, wrong);
    controller.parameters[name] = value;
  }
  return controller;
}

}  // namespace

std::optional<FlightController> read_flight_controller(const toml::Table& uav) {
  constexpr const char* kKey = "flight_controller";
  if (!uav.has(kKey)) return std::nullopt;
  FlightController controller{.at = uav.where(kKey)};
  if (!uav.is_table(kKey)) {
    if (uav.choice(kKey, kKinds) == 0) return std::nullopt;
  } else {
    const toml::Table table =
        uav.table(kKey, {"kind", "link_baud", "link_latency_ms", "starts_in_air", "parameters"});
    if (table.choice("kind", kKinds) == 0) return std::nullopt;
    controller = read_settings(table, std::move(controller));
  }
  reject_beside_it(uav);
  return controller;
}

}  // namespace tether::scenario

#include "tables/read_flight_controller.h"

#include <array>
#include <string_view>

#include <tether/autopilot/built_in.h>

namespace tether::scenario {
namespace {

constexpr std::array<std::string_view, 2> kKinds = {"none", "built-in"};

}  // namespace

std::optional<FlightController> read_flight_controller(const toml::Table& uav) {
  constexpr toml::Range kBaud{.min = 0.0, .max = 1e9};
  constexpr toml::Range kLatency_ms{.min = 0.0, .max = 10'000.0};
  constexpr toml::Range kValue{.min = -1e9, .max = 1e9};
  constexpr const char* kKey = "flight_controller";
  if (!uav.has(kKey)) return std::nullopt;
  FlightController controller{.at = uav.where(kKey)};
  if (!uav.is_table(kKey)) {
    if (uav.choice(kKey, kKinds) == 0) return std::nullopt;
    return controller;
  }
  const toml::Table table =
      uav.table(kKey, {"kind", "link_baud", "link_latency_ms", "starts_in_air", "parameters"});
  if (table.choice("kind", kKinds) == 0) return std::nullopt;
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

}  // namespace tether::scenario

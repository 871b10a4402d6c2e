#include "tables/read_flight_controller.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <tether/autopilot/built_in.h>
#include <tether/autopilot/px4.h>

namespace tether::scenario {
namespace {

constexpr std::array<std::string_view, 3> kKinds = {"none", "built-in", "px4"};

/// With a flight controller, commands are its own.
void reject_beside_it(const toml::Table& uav) {
  for (const char* key :
       {"command_latency_ms", "command_latency", "setpoint_timeout_ms", "on_setpoint_loss"})
    if (uav.has(key))
      uav.fail(key,
               "has no effect beside 'flight_controller', which has its own link and time-out. "
               "Remove this key; see 'link_latency_ms' and the parameter COM_OF_LOSS_T.");
}

using Kind = FlightController::Kind;

/// Keys that only one kind has.
void reject_keys_of_others(const toml::Table& table, Kind kind) {
  constexpr std::array<std::pair<const char*, Kind>, 3> kKeys = {
      {{"starts_in_air", Kind::kBuiltIn}, {"path", Kind::kPx4}, {"boot_s", Kind::kPx4}}};
  for (const auto& [key, owner] : kKeys)
    if (table.has(key) && owner != kind)
      table.fail(key, fmt::format("is of the flight controller \"{}\" only. Remove this key.",
                                  kKinds[1 + static_cast<std::size_t>(owner)]));
}

std::string complaint_about_parameter(Kind kind, const std::string& name, double value) {
  if (kind == Kind::kBuiltIn) return autopilot::complaint_about_parameter(name, value);
  return autopilot::is_px4_parameter(name)
             ? ""
             : "is no name of a parameter of PX4, which has at most 16 capital letters, digits and "
               "'_'.";
}

std::map<std::string, double> read_parameters(const toml::Table& table, Kind kind) {
  constexpr toml::Range kValue{.min = -1e9, .max = 1e9};
  std::map<std::string, double> values;
  if (!table.has("parameters")) return values;
  const toml::Table parameters = table.table("parameters");
  for (const std::string& name : parameters.keys()) {
    const double value = parameters.number(name, kValue);
    if (const std::string wrong = complaint_about_parameter(kind, name, value); !wrong.empty())
      parameters.fail(name, wrong);
    values[name] = value;
  }
  return values;
}

FlightController read_settings(const toml::Table& table, FlightController controller) {
  constexpr toml::Range kBaud{.min = 0.0, .max = 1e9};
  constexpr toml::Range kLatency_ms{.min = 0.0, .max = 10'000.0};
  constexpr toml::Range kBoot_s{.min = 1.0, .max = 600.0};
  reject_keys_of_others(table, controller.kind);
  controller.link_baud = table.number_or("link_baud", kBaud, 0.0);
  controller.link_latency = table.duration_or("link_latency_ms", kLatency_ms, Duration{0});
  controller.starts_in_air = table.boolean_or("starts_in_air", false);
  controller.boot =
      duration_from_seconds(table.number_or("boot_s", kBoot_s, to_seconds(controller.boot)));
  controller.parameters = read_parameters(table, controller.kind);
  if (controller.kind == Kind::kPx4)
    controller.path =
        (std::filesystem::path(table.where("path").file).parent_path() / table.text("path"))
            .lexically_normal();
  return controller;
}

}  // namespace

std::optional<FlightController> read_flight_controller(const toml::Table& uav) {
  constexpr const char* kKey = "flight_controller";
  if (!uav.has(kKey)) return std::nullopt;
  FlightController controller;
  controller.at = uav.where(kKey);
  const auto take_kind = [&](std::size_t kind) {
    if (kind > 0) controller.kind = static_cast<Kind>(kind - 1);
    return kind > 0;
  };
  if (!uav.is_table(kKey)) {
    if (!take_kind(uav.choice(kKey, kKinds))) return std::nullopt;
    if (controller.kind != Kind::kBuiltIn)
      uav.fail(kKey,
               "needs settings: write [uav.flight_controller] with kind = \"px4\" and the "
               "'path' of PX4's build.");
  } else {
    const toml::Table table = uav.table(kKey, {"kind", "path", "boot_s", "link_baud",
                                               "link_latency_ms", "starts_in_air", "parameters"});
    if (!take_kind(table.choice("kind", kKinds))) return std::nullopt;
    controller = read_settings(table, std::move(controller));
  }
  reject_beside_it(uav);
  return controller;
}

}  // namespace tether::scenario

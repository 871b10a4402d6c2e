#include "tables/read_flight_controller.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tether/autopilot/external.h>
#include <tether/autopilot/flight_controller.h>
#include <tether/os/text_file.h>

namespace tether::scenario {
namespace {

/// The kinds, of which the last ones are those that the user brings.
std::vector<std::string_view> kinds() {
  std::vector<std::string_view> keys = {"none", "built-in"};
  for (const autopilot::External& kind : autopilot::externals()) keys.push_back(kind.key);
  return keys;
}

/// With a flight controller, commands are its own.
void reject_beside_it(const toml::Table& uav) {
  for (const char* key :
       {"command_latency_ms", "command_latency", "setpoint_timeout_ms", "on_setpoint_loss"})
    if (uav.has(key))
      uav.fail(key,
               "has no effect beside 'flight_controller', which has its own link and time-out. "
               "Remove this key; see 'link_latency_ms' and the parameter COM_OF_LOSS_T.");
}

/// Keys that only the built-in one has, or only the others.
void reject_keys_of_others(const toml::Table& table, const FlightController& controller) {
  const bool is_built_in = controller.external == nullptr;
  for (const auto& [key, of_built_in] :
       {std::pair{"starts_in_air", true}, {"path", false}, {"boot_s", false}})
    if (table.has(key) && of_built_in != is_built_in)
      table.fail(key,
                 is_built_in
                     ? "is of flight controllers that you bring, such as \"px4\". Remove this key."
                     : "is of the flight controller \"built-in\" only. Remove this key.");
}

std::string complaint_about_parameter(const FlightController& controller, const std::string& name,
                                      double value) {
  if (controller.external == nullptr) return autopilot::complaint_about_parameter(name, value);
  if (autopilot::is_external_parameter(name)) return "";
  return fmt::format(
      "is no name of a parameter of {}, which has at most 16 capital letters, digits and '_'.",
      controller.external->name);
}

std::map<std::string, double> read_parameters(const toml::Table& table,
                                              const FlightController& controller) {
  constexpr toml::Range kValue{.min = -1e9, .max = 1e9};
  std::map<std::string, double> values;
  if (!table.has("parameters")) return values;
  const toml::Table parameters = table.table("parameters");
  for (const std::string& name : parameters.keys()) {
    const double value = parameters.number(name, kValue);
    if (const std::string wrong = complaint_about_parameter(controller, name, value);
        !wrong.empty())
      parameters.fail(name, wrong);
    values[name] = value;
  }
  return values;
}

std::filesystem::path file_beside(const toml::Table& table, const char* key) {
  return (std::filesystem::path(table.where(key).file).parent_path() / table.text(key))
      .lexically_normal();
}

void read_signing_key(const toml::Table& table, FlightController& controller) {
  constexpr const char* kKey = "signing_key_file";
  if (!table.has(kKey)) return;
  controller.signing_key_file = file_beside(table, kKey);
  constexpr std::uintmax_t kMostBytes = 1000;
  controller.signing_key = os::read_file(controller.signing_key_file, kMostBytes);
  const std::string wrong = autopilot::complaint_about_signing_key(controller.signing_key);
  if (!wrong.empty()) table.fail(kKey, fmt::format("cannot be used: {}.", wrong));
}

FlightController read_settings(const toml::Table& table, FlightController controller) {
  constexpr toml::Range kBaud{.min = 0.0, .max = 1e9};
  constexpr toml::Range kLatency_ms{.min = 0.0, .max = 10'000.0};
  // In the order of GroundStation.
  constexpr std::array<std::string_view, 3> kGroundStations = {"none", "looks", "commands"};
  constexpr std::int64_t kLeastPort = 1024, kLargestPort = 65'535;
  constexpr toml::Range kBoot_s{.min = 1.0, .max = 600.0};
  reject_keys_of_others(table, controller);
  controller.link_baud = table.number_or("link_baud", kBaud, 0.0);
  controller.link_latency = table.duration_or("link_latency_ms", kLatency_ms, Duration{0});
  controller.starts_in_air = table.boolean_or("starts_in_air", false);
  controller.parameters = read_parameters(table, controller);
  if (table.has("ground_station"))
    controller.ground_station =
        static_cast<autopilot::GroundStation>(table.choice("ground_station", kGroundStations));
  controller.ground_station_port = static_cast<std::uint16_t>(table.integer_or(
      "ground_station_port", kLeastPort, kLargestPort, autopilot::kGroundStationPort));
  read_signing_key(table, controller);
  if (controller.external == nullptr) return controller;
  controller.has_fixed_ports = controller.external->has_fixed_ports;
  controller.boot = duration_from_seconds(
      table.number_or("boot_s", kBoot_s, to_seconds(controller.external->boot)));
  controller.path = file_beside(table, "path");
  return controller;
}

}  // namespace

std::optional<FlightController> read_flight_controller(const toml::Table& uav) {
  constexpr const char* kKey = "flight_controller";
  if (!uav.has(kKey)) return std::nullopt;
  FlightController controller;
  controller.at = uav.where(kKey);
  const std::vector<std::string_view> all = kinds();
  const auto take_kind = [&](std::size_t kind) {
    constexpr std::size_t kFirstExternal = 2;
    if (kind >= kFirstExternal)
      controller.external = &autopilot::externals()[kind - kFirstExternal];
    return kind > 0;
  };
  if (!uav.is_table(kKey)) {
    if (!take_kind(uav.choice(kKey, all))) return std::nullopt;
    if (const autopilot::External* const external = controller.external)
      uav.fail(kKey, fmt::format("needs settings: write [uav.flight_controller] with kind = \"{}\" "
                                 "and the 'path' of {}'s build.",
                                 external->key, external->name));
  } else {
    const toml::Table table = uav.table(
        kKey, {"kind", "path", "boot_s", "link_baud", "link_latency_ms", "starts_in_air",
               "parameters", "ground_station", "ground_station_port", "signing_key_file"});
    if (!take_kind(table.choice("kind", all))) return std::nullopt;
    controller = read_settings(table, std::move(controller));
  }
  reject_beside_it(uav);
  return controller;
}

}  // namespace tether::scenario

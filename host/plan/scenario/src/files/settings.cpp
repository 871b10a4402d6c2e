#include "files/settings.h"

#include "files/scenario_keys.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/text.h>

namespace tether::scenario {

Setting parse_setting(std::string_view text, const std::filesystem::path& folder) {
  const std::size_t sign = text.find('=');
  if (sign == 0 || sign == std::string_view::npos || sign + 1 == text.size())
    throw Error(ErrorCode::kUsage,
                fmt::format("--set {}: must be KEY=VALUE, for instance time_limit_s=30", text))
        .about(std::string(text));
  Setting setting{std::string(text.substr(0, sign)), std::string(text.substr(sign + 1))};
  std::error_code ignored;
  const std::filesystem::path file = folder / setting.value;
  if (std::filesystem::is_regular_file(file, ignored))
    setting.value = std::filesystem::absolute(file).lexically_normal().string();
  return setting;
}

void keep_first_uavs(Scenario& scenario, const std::string& count) {
  std::size_t kept = 0;
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), kept);
  if (error != std::errc() || end != count.data() + count.size() || kept < 1 ||
      kept > scenario.uavs.size())
    throw Error(ErrorCode::kUsage, {scenario.file.string()},
                fmt::format("has {} UAVs, of which {}={} cannot be flown. Use a whole number from "
                            "1 to {}",
                            scenario.uavs.size(), kUavCount, count, scenario.uavs.size()))
        .about(std::string(kUavCount));
  const auto is_of_dropped = [&](std::string_view owner) {
    return std::any_of(scenario.uavs.begin() + static_cast<std::ptrdiff_t>(kept),
                       scenario.uavs.end(),
                       [&](const UavSetup& uav) { return uav.placement.name == owner; });
  };
  std::erase_if(scenario.variations, [&](const Variation& variation) {
    return is_of_dropped(std::string_view(variation.of).substr(0, variation.of.find('.')));
  });
  std::erase_if(scenario.payloads,
                [&](const CarriedPayload& payload) { return is_of_dropped(payload.uav); });
  scenario.uavs.resize(kept);
  std::erase_if(scenario.metrics, [&](const Metric& metric) {
    return std::ranges::none_of(
        scenario.uavs, [&](const UavSetup& uav) { return uav.placement.name == metric.uav; });
  });
  for (Condition& condition : scenario.conditions) {
    if (condition.seats.empty()) continue;
    condition.seats.resize(kept);
    std::vector<Computer> computers;
    for (std::size_t i = 0; i < condition.computers.size(); ++i) {
      if (std::ranges::count(condition.seats, i, &Seat::computer) == 0) continue;
      for (Seat& seat : condition.seats)
        if (seat.computer == i) seat.computer = computers.size();
      computers.push_back(condition.computers[i]);
    }
    condition.computers = std::move(computers);
  }
}

namespace {

struct KeyTable {
  std::string from;  ///< before a key that is given without the path of its table
  std::span<const std::string_view> keys;
};
const std::array<KeyTable, 4> kKeyTables = {
    KeyTable{"", kScenarioKeys}, KeyTable{"condition.", kConditionKeys}, KeyTable{"uav.", kUavKeys},
    KeyTable{"target.", kComputerKeys}};

/// Not parameters, sensors and metrics, whose names are free: a new one may be a typing error.
bool may_be_added(const KeyTable& table, const std::string& key) {
  const auto dots = std::ranges::count(table.from + key, '.');
  const std::string_view first = std::string_view(key).substr(0, key.find('.'));
  const bool is_free = first == "metric" || first == "sensors";
  return dots < 2 && !is_free && std::ranges::count(table.keys, first) > 0;
}

/// "vary.NAME.value" or "vary.NAME.of", of a table that the file has.
bool is_of_a_variation(const Setting& setting, const toml::Table& root) {
  constexpr std::string_view kFirst = "vary.";
  const std::string_view key = setting.key;
  if (!key.starts_with(kFirst) || !root.has("vary")) return false;
  const std::size_t dot = key.rfind('.');
  const std::string_view last = key.substr(dot + 1);
  return (last == "value" || last == "of") && dot > kFirst.size() &&
         root.table("vary").has(key.substr(kFirst.size(), dot - kFirst.size()));
}

}  // namespace

bool apply(const Setting& setting, toml::Document& scenario) {
  for (const KeyTable& table : kKeyTables)
    if (scenario.replace(table.from + setting.key, setting.value) > 0) return true;
  if (is_of_a_variation(setting, scenario.root()))
    return scenario.add(setting.key, setting.value) > 0;
  for (const KeyTable& table : kKeyTables)
    if (may_be_added(table, setting.key))
      return scenario.add(table.from + setting.key, setting.value) > 0;
  return false;
}

namespace {

std::string suggestion(const std::string& key) {
  for (const std::string_view list : {"moving", "payload"})
    if (key.starts_with(list) && std::ranges::count(key, '.') > 1)
      return fmt::format(". The tables [[{}]] have no names: '{}{}' is that key of each.", list,
                         list, key.substr(key.rfind('.')));
  std::vector<std::string_view> keys;
  for (const KeyTable& table : kKeyTables)
    keys.insert(keys.end(), table.keys.begin(), table.keys.end());
  const std::string_view near = nearest(key, keys);
  return near.empty() ? "." : fmt::format("; did you mean '{}'?", near);
}

}  // namespace

void apply_to_profiles(const std::vector<Setting>& settings, Scenario& scenario) {
  if (settings.empty()) return;
  std::set<std::string> replaced;
  const auto reload = [&](Profile& profile) {
    profile = load_profile(profile.file, settings, replaced);
  };
  for (UavSetup& uav : scenario.uavs)
    if (uav.profile) reload(*uav.profile);
  for (Condition& condition : scenario.conditions)
    for (Profile& profile : condition.profiles) reload(profile);
  for (const Setting& setting : settings)
    if (!replaced.contains(setting.key))
      throw Error(ErrorCode::kUsage, {scenario.file.string()},
                  fmt::format("has no value '{}' to replace{} Give the path of a key that the file "
                              "or a profile of its sensors has, such as time_limit_s, "
                              "condition.cpu_factor, sut.parameters.KEY or sensors.camera.rate_hz",
                              setting.key, suggestion(setting.key)))
          .about(setting.key);
}

std::string name_suffix(const std::vector<Setting>& settings) {
  std::string suffix;
  for (auto [key, value] : settings) {
    if (value.starts_with('['))
      std::erase_if(value, [](char c) {
        return std::string_view("[]\" ").find(c) != std::string_view::npos;
      });
    const bool is_path = value.find('/') != std::string::npos;
    suffix += "-" + key.substr(key.rfind('.') + 1) + "-" +
              (is_path ? std::filesystem::path(value).stem().string() : value);
  }
  constexpr std::string_view kKept =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
  for (char& c : suffix)
    if (kKept.find(c) == std::string_view::npos) c = '-';
  return suffix;
}

}  // namespace tether::scenario

#include "tables/read_sensor_profile.h"

#include "sensors/sensor_key.h"
#include "tables/read_delay.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/base/units.h>

// The table of one sensor: keys of timing and mounting, which any sensor has, and those of its kind
// (sensors/). Where the table does not say the kind, a key is read for each kind that has it.
namespace tether::scenario {
namespace {

using uav::SensorKind;

constexpr std::array<std::string_view, 6> kOfAny = {"kind",      "timing",   "rate_hz",
                                                    "period_ms", "phase_ms", "delay"};

std::vector<SensorKind> kinds(std::optional<SensorKind> only) {
  if (only) return {*only};
  std::vector<SensorKind> all;
  for (std::size_t i = 0; i < kSensorKinds; ++i) all.push_back(static_cast<SensorKind>(i));
  return all;
}

// Timing.

constexpr std::array<std::string_view, 3> kPeriodicKeys = {"rate_hz", "period_ms", "phase_ms"};

Duration read_period(const toml::Table& sensor) {
  if (sensor.has("rate_hz") == sensor.has("period_ms")) {
    sensor.fail("needs either 'rate_hz' or 'period_ms', because its timing is \"periodic\".");
  }
  constexpr toml::Range kRate_hz{.min = 1e-3, .max = 1e5};
  constexpr toml::Range kPeriod_ms{.min = 1e-2, .max = 1e6};
  if (sensor.has("period_ms")) return sensor.duration("period_ms", kPeriod_ms);
  return duration_from_seconds(1.0 / sensor.number("rate_hz", kRate_hz));
}

uav::PeriodicTiming read_periodic(const toml::Table& sensor, const uav::Delay& delay) {
  constexpr toml::Range kPhase_ms{.min = 0.0, .max = 1e6};
  return {read_period(sensor), sensor.duration_or("phase_ms", kPhase_ms, Duration{0}), delay};
}

void read_timing(const toml::Table& sensor, std::vector<std::filesystem::path>& files,
                 SensorProfile& profile) {
  constexpr std::array<std::string_view, 2> kTimings = {"periodic", "on_demand"};
  if (sensor.has("delay")) profile.delay = read_delay(sensor, "delay", files);
  const uav::Delay delay = profile.delay.value_or(uav::ConstantDelay{});
  if (sensor.has("timing") && sensor.choice("timing", kTimings) == 0) {
    profile.timing = read_periodic(sensor, delay);
    return;
  }
  for (const std::string_view key : kPeriodicKeys) {
    if (!sensor.has(key)) continue;
    if (!sensor.has("timing")) {
      sensor.fail("timing", fmt::format("is missing. '{}' needs timing = \"periodic\" in the same "
                                        "table.",
                                        key));
    }
    sensor.fail(key, "needs timing = \"periodic\", but the timing is \"on_demand\".");
  }
  if (sensor.has("timing")) profile.timing = uav::OnDemandTiming{delay};
}

// Mounting.

SensorSetter position(const toml::Table& sensor, std::string_view key) {
  constexpr toml::Range kPosition_m{.min = -100.0, .max = 100.0};
  const auto p = sensor.numbers(key, 3, kPosition_m);
  return [p_BS = uav::Vec3{p[0], p[1], p[2]}](sim::Sensor& s) { s.X_BS.p = p_BS; };
}

SensorSetter attitude(const toml::Table& sensor, std::string_view key) {
  constexpr toml::Range kAngle_deg{.min = -360.0, .max = 360.0};
  const auto rpy = sensor.numbers(key, 3, kAngle_deg);
  const uav::Quat q_BS =
      uav::from_rpy(rad_from_deg(rpy[0]), rad_from_deg(rpy[1]), rad_from_deg(rpy[2]));
  return [q_BS](sim::Sensor& s) { s.X_BS.q = q_BS; };
}

const std::vector<SensorKey> kMounting = {{"position_m", position}, {"rpy_deg", attitude}};

// Driver.

/// Sets a member of the driver's model.
SensorKey driver_key(std::string_view name, auto read, auto set) {
  return {name, [read, set](const toml::Table& table, std::string_view key) -> SensorSetter {
            return [set, value = read(table, key)](sim::Sensor& s) { set(s.driver, value); };
          }};
}

const std::vector<SensorKey>& driver_keys() {
  using uav::DriverModel;
  // Of a certain loss, no sample would ever arrive.
  constexpr toml::Range kNotCertain{.min = 0.0, .max = 0.99};
  constexpr toml::Range kDrift_ppm{.min = -1e5, .max = 1e5};
  const auto duration = [](double least_ms, double most_ms) {
    return [=](const toml::Table& table, std::string_view key) {
      return table.duration(key, {.min = least_ms, .max = most_ms});
    };
  };
  static const std::vector<SensorKey> keys = {
      driver_key("stamp_offset_ms", duration(-6e4, 6e4),
                 [](DriverModel& m, Duration offset) { m.stamp_offset = offset; }),
      driver_key("stamp_jitter_ms", duration(0.0, 6e4),
                 [](DriverModel& m, Duration jitter) { m.stamp_jitter = jitter; }),
      driver_key("stamp_drift_ppm", number(kDrift_ppm, 1e3),
                 [](DriverModel& m, double ppb) {
                   m.stamp_drift_ppb = static_cast<int>(std::lround(ppb));
                 }),
      driver_key("lost_probability", number(kNotCertain),
                 [](DriverModel& m, double share) { m.lost_probability = share; }),
      driver_key("repeated_probability", number(kNotCertain),
                 [](DriverModel& m, double share) { m.repeated_probability = share; }),
  };
  return keys;
}

/// The keys for sensors of these kinds.
std::vector<std::string_view> names_of_keys(const std::vector<SensorKind>& kinds) {
  std::vector<std::string_view> names(kOfAny.begin(), kOfAny.end());
  const auto add = [&names](const std::vector<SensorKey>& keys) {
    for (const SensorKey& key : keys)
      if (std::ranges::count(names, key.name) == 0) names.push_back(key.name);
  };
  add(kMounting);
  add(driver_keys());
  for (const SensorKind kind : kinds) add(keys_of(kind));
  return names;
}

/// A kind whose sensors have the key.
SensorKind kind_with(std::string_view key) {
  const auto has_it = [&](SensorKind kind) {
    return std::ranges::count(keys_of(kind), key, &SensorKey::name) > 0;
  };
  const std::vector<SensorKind> all = kinds(std::nullopt);
  return *std::ranges::find_if(all, has_it);
}

}  // namespace

FileLocation SensorProfile::at(std::string_view key) const {
  const auto found = lines.find(key);
  return found == lines.end() ? where : FileLocation{where.file, found->second};
}

SensorProfile read_sensor_profile(const toml::Table& sensors, std::string_view name,
                                  KindKey kind_key, std::vector<std::filesystem::path>& files) {
  SensorProfile profile;
  const toml::Table any = sensors.table(name);
  profile.where = any.where();
  for (const std::string& key : any.keys()) profile.lines[key] = any.where(key).line;
  if (any.has("kind")) {
    std::vector<std::string_view> names;
    for (const SensorKind kind : kinds(std::nullopt)) names.push_back(uav::name(kind));
    profile.kind = static_cast<SensorKind>(any.choice("kind", names));
    require_kind(profile, name, *profile.kind);
  }

  const toml::Table sensor = sensors.table(name, names_of_keys(kinds(profile.kind)));
  if (kind_key == KindKey::kRequired && !profile.kind) (void)sensor.text("kind");
  read_timing(sensor, files, profile);
  const auto read = [&](const std::vector<SensorKey>& keys, std::optional<SensorKind> kind) {
    for (const SensorKey& key : keys)
      if (sensor.has(key.name)) profile.settings.push_back({kind, key.read(sensor, key.name)});
  };
  read(kMounting, std::nullopt);
  read(driver_keys(), std::nullopt);
  for (const SensorKind kind : kinds(profile.kind)) read(keys_of(kind), kind);
  return profile;
}

void require_kind(const SensorProfile& profile, std::string_view sensor, SensorKind kind) {
  const std::vector<std::string_view> allowed = names_of_keys({kind});
  for (const std::string_view key : names_of_keys(kinds(std::nullopt))) {
    if (!profile.lines.contains(key) || std::ranges::count(allowed, key) > 0) continue;
    throw Error(ErrorCode::kBadFile, profile.at(key),
                fmt::format("'{}' is a key of the kind \"{}\", but the sensor '{}' is of the kind "
                            "\"{}\"; {}",
                            key, uav::name(kind_with(key)), sensor, uav::name(kind),
                            allowed_hint(key, allowed)))
        .about(std::string(key));
  }
}

}  // namespace tether::scenario

#include "tables/read_sensor_profile.h"

#include "tables/read_delay.h"

#include <array>

#include <fmt/format.h>

#include <tether/base/suggest.h>
#include <tether/base/units.h>

// The table of one sensor. `kKeys` lists which kind of sensor supports which key; the functions
// below read keys of timing, mounting and measuring, each only if it is there.
namespace tether::scenario {
namespace {

using uav::SensorKind;

/// In the order of SensorKind.
constexpr std::array<std::string_view, 3> kSensorKinds = {"camera", "imu", "range"};

struct KeyRule {
  std::string_view key;
  std::optional<SensorKind> kind{};  // none: of any
  std::optional<SensorKind> other_kind{};

  bool allows(SensorKind sensor) const { return !kind || kind == sensor || other_kind == sensor; }
};

constexpr std::array kKeys = {
    KeyRule{"kind"},
    KeyRule{"timing"},
    KeyRule{"rate_hz"},
    KeyRule{"period_ms"},
    KeyRule{"phase_ms"},
    KeyRule{"delay"},
    KeyRule{"position_m"},
    KeyRule{"rpy_deg"},
    KeyRule{"size_px", SensorKind::kCamera},
    KeyRule{"horizontal_fov_deg", SensorKind::kCamera},
    KeyRule{"distortion", SensorKind::kCamera},
    KeyRule{"noise", SensorKind::kCamera},
    KeyRule{"exposure_ms", SensorKind::kCamera},
    KeyRule{"readout_ms", SensorKind::kCamera},
    KeyRule{"antialias", SensorKind::kCamera},
    KeyRule{"angular_velocity_noise_rad_s", SensorKind::kImu},
    KeyRule{"linear_acceleration_noise_m_s2", SensorKind::kImu},
    KeyRule{"min_m", SensorKind::kRange, SensorKind::kCamera},
    KeyRule{"max_m", SensorKind::kRange, SensorKind::kCamera},
    KeyRule{"resolution_m", SensorKind::kRange},
    KeyRule{"field_of_view_deg", SensorKind::kRange},
    KeyRule{"dropout_probability", SensorKind::kRange},
    KeyRule{"noise_m", SensorKind::kRange},
};

/// The keys for a sensor of that kind; without a kind, all.
std::vector<std::string_view> keys_of(std::optional<SensorKind> kind) {
  std::vector<std::string_view> keys;
  for (const KeyRule& rule : kKeys) {
    if (!kind || rule.allows(*kind)) keys.push_back(rule.key);
  }
  return keys;
}

std::optional<SensorKind> read_kind(const toml::Table& sensor) {
  if (!sensor.has("kind")) return std::nullopt;
  return static_cast<SensorKind>(sensor.choice("kind", kSensorKinds));
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
  if (sensor.has("delay")) profile.delay = read_delay(sensor, files);
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

void read_mounting(const toml::Table& sensor, SensorProfile& profile) {
  constexpr toml::Range kPosition_m{.min = -100.0, .max = 100.0};
  constexpr toml::Range kAngle_deg{.min = -360.0, .max = 360.0};
  if (sensor.has("position_m")) {
    const auto p = sensor.numbers("position_m", 3, kPosition_m);
    profile.p_BS = uav::Vec3{p[0], p[1], p[2]};
  }
  if (sensor.has("rpy_deg")) {
    const auto rpy = sensor.numbers("rpy_deg", 3, kAngle_deg);
    profile.q_BS = uav::from_rpy(rad_from_deg(rpy[0]), rad_from_deg(rpy[1]), rad_from_deg(rpy[2]));
  }
}

// Measuring.

std::optional<double> scaled(const std::optional<double>& value, double factor) {
  return value ? std::optional(*value * factor) : std::nullopt;
}

std::optional<sim::Noise> read_noise(const toml::Table& sensor, std::string_view key) {
  constexpr toml::Range kMean{.min = -1e6, .max = 1e6};
  constexpr toml::Range kSpread{.min = 0.0, .max = 1e6};
  if (!sensor.has(key)) return std::nullopt;
  const toml::Table table =
      sensor.table(key, {"mean", "stddev", "bias_mean", "bias_stddev", "dynamic_bias_stddev",
                         "dynamic_bias_correlation_time_s"});
  sim::Noise noise;
  noise.mean = table.number_or("mean", kMean, 0.0);
  noise.stddev = table.number_or("stddev", kSpread, 0.0);
  noise.bias_mean = table.number_or("bias_mean", kMean, 0.0);
  noise.bias_stddev = table.number_or("bias_stddev", kSpread, 0.0);
  noise.dynamic_bias_stddev = table.number_or("dynamic_bias_stddev", kSpread, 0.0);
  noise.dynamic_bias_correlation_time_s =
      table.number_or("dynamic_bias_correlation_time_s", kSpread, 0.0);
  if (noise.dynamic_bias_stddev > 0.0 && noise.dynamic_bias_correlation_time_s == 0.0) {
    table.fail("dynamic_bias_correlation_time_s",
               "must be greater than 0, because 'dynamic_bias_stddev' is.");
  }
  return noise;
}

std::optional<ImageSize> read_size(const toml::Table& camera) {
  constexpr std::int64_t kLongestEdge_px = 4096;
  if (!camera.has("size_px")) return std::nullopt;
  const std::vector<std::int64_t> size = camera.integers("size_px", 1);
  if (size.size() != 2) {
    camera.fail("size_px",
                fmt::format("must be [width, height], but has {} elements", size.size()));
  }
  for (const std::int64_t edge_px : size) {
    if (edge_px <= kLongestEdge_px) continue;
    camera.fail("size_px",
                fmt::format("must be at most {} each, but has {}", kLongestEdge_px, edge_px));
  }
  return ImageSize{static_cast<int>(size[0]), static_cast<int>(size[1])};
}

std::optional<Distortion> read_distortion(const toml::Table& camera) {
  constexpr toml::Range kCoefficient{.min = -100.0, .max = 100.0};
  if (!camera.has("distortion")) return std::nullopt;
  const toml::Table table = camera.table("distortion", {"k1", "k2", "k3", "p1", "p2"});
  const auto coefficient = [&](std::string_view key) {
    return table.number_or(key, kCoefficient, 0.0);
  };
  return Distortion{coefficient("k1"), coefficient("k2"), coefficient("k3"), coefficient("p1"),
                    coefficient("p2")};
}

void read_camera(const toml::Table& camera, SensorProfile& profile) {
  constexpr toml::Range kFieldOfView_deg{.min = 0.3, .max = 179.9};
  constexpr toml::Range kTime_ms{.min = 0.0, .max = 1000.0};
  profile.size = read_size(camera);
  profile.horizontal_fov_rad =
      scaled(camera.number_if("horizontal_fov_deg", kFieldOfView_deg), rad_from_deg(1.0));
  profile.distortion = read_distortion(camera);
  profile.pixel_noise = read_noise(camera, "noise");
  profile.exposure_s = scaled(camera.number_if("exposure_ms", kTime_ms), 1e-3);
  profile.readout_s = scaled(camera.number_if("readout_ms", kTime_ms), 1e-3);
  if (camera.has("antialias")) profile.antialias = camera.boolean("antialias");
}

void read_imu(const toml::Table& imu, SensorProfile& profile) {
  profile.angular_velocity_noise = read_noise(imu, "angular_velocity_noise_rad_s");
  profile.linear_acceleration_noise = read_noise(imu, "linear_acceleration_noise_m_s2");
}

constexpr toml::Range kDistance_m{.min = 0.0, .max = 1e5};

void read_limits(const toml::Table& sensor, SensorProfile& profile) {
  constexpr toml::Range kFarthest_m{.min = 0.0, .max = 1e5, .above_min = true};
  profile.min_m = sensor.number_if("min_m", kDistance_m);
  profile.max_m = sensor.number_if("max_m", kFarthest_m);
}

void read_range(const toml::Table& range, SensorProfile& profile) {
  constexpr toml::Range kFieldOfView_deg{.min = 0.0, .max = 180.0, .below_max = true};
  constexpr toml::Range kProbability{.min = 0.0, .max = 1.0};
  profile.resolution_m = range.number_if("resolution_m", kDistance_m);
  profile.field_of_view_rad =
      scaled(range.number_if("field_of_view_deg", kFieldOfView_deg), rad_from_deg(1.0));
  profile.dropout_probability = range.number_if("dropout_probability", kProbability);
  profile.range_noise = read_noise(range, "noise_m");
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
  profile.kind = read_kind(any);
  if (profile.kind) require_kind(profile, name, *profile.kind);

  const toml::Table sensor = sensors.table(name, keys_of(profile.kind));
  if (kind_key == KindKey::kRequired && !profile.kind) (void)sensor.text("kind");
  read_timing(sensor, files, profile);
  read_mounting(sensor, profile);
  read_limits(sensor, profile);
  read_camera(sensor, profile);
  read_imu(sensor, profile);
  read_range(sensor, profile);
  return profile;
}

void require_kind(const SensorProfile& profile, std::string_view sensor, SensorKind kind) {
  for (const KeyRule& rule : kKeys) {
    if (rule.allows(kind) || !profile.lines.contains(rule.key)) continue;
    throw Error(ErrorCode::kBadFile, profile.at(rule.key),
                fmt::format("'{}' is a key of the kind \"{}\", but the sensor '{}' is of the kind "
                            "\"{}\"; {}",
                            rule.key, uav::name(*rule.kind), sensor, uav::name(kind),
                            allowed_hint(rule.key, keys_of(kind))))
        .about(std::string(rule.key));
  }
}

}  // namespace tether::scenario

#include "sensor_setup.h"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

namespace tether::scenario {
namespace {

constexpr double kLongestDelay_ms = 60'000.0;
constexpr Range kDelay_ms{.min = 0.0, .max = kLongestDelay_ms};

std::string_view trimmed(std::string_view line) {
  const auto first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

Duration parse_sample(std::string_view text, double seconds_per_unit, const FileLocation& at) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw Error(ErrorCode::kBadFile, at,
                fmt::format("expected one number on the line, found \"{}\"", text.substr(0, 40)));
  }
  const Range range{.min = 0.0, .max = kLongestDelay_ms * 1e-3 / seconds_per_unit};
  if (!range.contains(value)) {
    throw Error(ErrorCode::kBadFile, at,
                fmt::format("a delay must be {}, but is {}", range.text(), value));
  }
  return duration_from_seconds(value * seconds_per_unit);
}

uav::Delay read_empirical(const TomlTable& delay, std::vector<std::filesystem::path>& files) {
  if (delay.has("file_ms") == delay.has("file_s")) {
    delay.fail("needs either 'file_ms' or 'file_s': a file with one delay per line in that unit");
  }
  const std::string_view key = delay.has("file_ms") ? "file_ms" : "file_s";
  files.push_back(delay.existing_file(key));
  return uav::EmpiricalDelay{read_delay_samples(files.back(), key == "file_ms" ? 1e-3 : 1.0)};
}

// The kind decides which keys are allowed, so it is read first, with any key allowed.
uav::Delay read_delay(const TomlTable& sensor, std::vector<std::filesystem::path>& files) {
  if (!sensor.has("delay")) return uav::ConstantDelay{};
  constexpr std::array<std::string_view, 3> kKinds = {"constant", "normal", "empirical"};
  switch (sensor.table("delay").choice("kind", kKinds)) {
    case 0: {
      const TomlTable delay = sensor.table("delay", {"kind", "ms"});
      return uav::ConstantDelay{delay.duration("ms", kDelay_ms)};
    }
    case 1: {
      const TomlTable delay = sensor.table("delay", {"kind", "mean_ms", "stddev_ms"});
      return uav::NormalDelay{delay.duration("mean_ms", kDelay_ms),
                              delay.duration("stddev_ms", kDelay_ms)};
    }
    default:
      return read_empirical(sensor.table("delay", {"kind", "file_ms", "file_s"}), files);
  }
}

Duration read_period(const TomlTable& sensor) {
  if (sensor.has("rate_hz") == sensor.has("period_ms")) {
    sensor.fail("needs either 'rate_hz' or 'period_ms', because its timing is \"periodic\"");
  }
  constexpr Range kRate_hz{.min = 1e-3, .max = 1e5};
  constexpr Range kPeriod_ms{.min = 1e-2, .max = 1e6};
  if (sensor.has("period_ms")) return sensor.duration("period_ms", kPeriod_ms);
  return duration_from_seconds(1.0 / sensor.number("rate_hz", kRate_hz));
}

}  // namespace

std::vector<Duration> read_delay_samples(const std::filesystem::path& file,
                                         double seconds_per_unit) {
  constexpr std::size_t kLargestFile = std::size_t{64} << 20;
  const std::string text = read_text_file(file, kLargestFile);
  std::vector<Duration> samples;
  int line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = trimmed(std::string_view(text).substr(begin, end - begin));
    const FileLocation at{file.string(), ++line_number};
    if (!line.empty() && line.front() != '#') {
      samples.push_back(parse_sample(line, seconds_per_unit, at));
    }
    begin = end + 1;
  }
  if (samples.empty()) {
    throw Error(ErrorCode::kBadFile, FileLocation{file.string()},
                "holds no delay; expected one number per line");
  }
  return samples;
}

SensorSetup read_sensor_setup(const TomlTable& sensors, std::string_view name,
                              std::vector<std::filesystem::path>& files) {
  constexpr std::array<std::string_view, 2> kTimings = {"periodic", "on_demand"};
  const TomlTable any =
      sensors.table(name, {"timing", "rate_hz", "period_ms", "phase_ms", "delay"});
  const int line = any.where().line;
  if (any.choice("timing", kTimings) == 1) {
    const TomlTable sensor = sensors.table(name, {"timing", "delay"});
    return {uav::OnDemandTiming{read_delay(sensor, files)}, line};
  }
  constexpr Range kPhase_ms{.min = 0.0, .max = 1e6};
  uav::PeriodicTiming timing;
  timing.period = read_period(any);
  timing.phase = any.duration_or("phase_ms", kPhase_ms, Duration{0});
  timing.delay = read_delay(any, files);
  return {timing, line};
}

}  // namespace tether::scenario

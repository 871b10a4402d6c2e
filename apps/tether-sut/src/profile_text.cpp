#include "profile_text.h"

#include <algorithm>

#include <tether/base/version.h>

namespace tether::sut {
namespace {

constexpr std::size_t kSamplesPerLine = 8;
constexpr std::string_view kNameCharacters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
constexpr std::size_t kLongestName = 64;

/// Milliseconds with as many digits as the nanoseconds need: "33.1", "0.000001".
std::string in_ms(Duration time) {
  const std::int64_t ns = std::max<std::int64_t>(to_ns(time), 0);
  std::string digits = std::to_string(ns % 1'000'000);
  digits.insert(0, 6 - digits.size(), '0');
  digits.erase(std::max(digits.find_last_not_of('0') + 1, std::size_t{1}));
  return std::to_string(ns / 1'000'000) + "." + digits;
}

/// In a comment, where control characters must not stand.
std::string plain(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  return text;
}

/// A basic string, also where a key must be quoted.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : plain(text)) {
    result += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  }
  return result + "\"";
}

std::string key(const std::string& name) {
  const bool is_bare = !name.empty() && name.find('.') == std::string::npos &&
                       name.find_first_not_of(kNameCharacters) == std::string::npos;
  return is_bare ? name : quoted(name);
}

std::string samples_text(const std::vector<Duration>& samples) {
  std::string text = "samples_ms = [";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    text += i % kSamplesPerLine == 0 ? "\n  " : " ";
    text += in_ms(samples[i]) + ",";
  }
  return text + "\n]\n";
}

std::string sensor_text(const ProfiledSensor& sensor) {
  const std::string table = "sensors." + key(sensor.name);
  std::string text = "\n# " + plain(sensor.source) + ", " +
                     std::to_string(sensor.timing.delays.size()) + " measured\n[" + table + "]\n";
  text += "kind = " + quoted(std::string(uav::name(sensor.kind))) + "\n";
  if (sensor.timing.period) {
    text += "timing = \"periodic\"\nperiod_ms = " + in_ms(*sensor.timing.period) + "\n";
  } else {
    text += "timing = \"on_demand\"\n";
  }
  return text + "\n[" + table + ".delay]\nkind = \"empirical\"\n" +
         samples_text(sensor.timing.delays);
}

}  // namespace

bool is_profile_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && name.front() != '.' &&
         name.find_first_not_of(kNameCharacters) == std::string_view::npos;
}

std::string profile_name_from(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return kNameCharacters.find(c) == std::string_view::npos; }, '_');
  text.erase(0, text.find_first_not_of('.'));
  text.resize(std::min(text.size(), kLongestName));
  return text.empty() ? "measured" : text;
}

std::string profile_text(const MeasuredProfile& profile) {
  std::string names;
  for (const ProfiledSensor& sensor : profile.sensors) {
    names += (names.empty() ? "" : ", ") + sensor.name;
  }
  const std::string extent = std::to_string(profile.experiments) +
                             (profile.experiments == 1 ? " experiment of " : " experiments of ") +
                             std::to_string(profile.acquisitions) + " acquisitions each";
  std::string text = "# Measured by tether-sut " + std::string(version()) + " on " +
                     plain(profile.where) + ", " + plain(profile.when) + ".\n";
  text += "# The paper's Algorithm 1: " + extent + ".\n";
  text += "name = " + quoted(profile.name) + "\n";
  text += "description = " + quoted(names + " as measured on " + profile.where) + "\n";
  for (const ProfiledSensor& sensor : profile.sensors) {
    text += sensor_text(sensor);
  }
  return text;
}

}  // namespace tether::sut

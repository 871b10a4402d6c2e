#include <algorithm>

#include <tether/base/version.h>
#include <tether/calibration/characterize.h>

// Writes a profile as TOML. Names and descriptions can contain any bytes, so they are made valid
// UTF-8 and escaped; passwords in URLs are removed.
namespace tether::calibration {
namespace {

constexpr std::size_t kSamplesPerLine = 8;
constexpr std::string_view kNameCharacters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
constexpr std::size_t kLongestName = 64;
constexpr Duration kLongestDelay = std::chrono::seconds(60);

/// Milliseconds with as many digits as the nanoseconds need: "33.1", "0.000001".
std::string in_ms(Duration time) {
  const std::int64_t ns = std::max<std::int64_t>(to_ns(time), 0);
  std::string digits = std::to_string(ns % 1'000'000);
  digits.insert(0, 6 - digits.size(), '0');
  digits.erase(std::max(digits.find_last_not_of('0') + 1, std::size_t{1}));
  return std::to_string(ns / 1'000'000) + "." + digits;
}

/// How many bytes the character at the beginning has; 0: that is no UTF-8.
std::size_t utf8_length(std::string_view text) {
  const auto at = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const unsigned lead = at(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                                           : 4;
  if (length < 2) return length;
  // Neither longer than needed, nor a surrogate, nor beyond U+10FFFF.
  const unsigned least = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  const unsigned most = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  if (lead > 0xF4 || at(1) < least || at(1) > most) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if (at(i) < 0x80 || at(i) > 0xBF) return 0;
  }
  return length;
}

/// In UTF-8: '?' for each byte that is none.
std::string in_utf8(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    result += length == 0 ? "?" : text.substr(0, length);
    text.remove_prefix(std::max(length, std::size_t{1}));
  }
  return result;
}

bool is_control(char c) {
  const auto code = static_cast<unsigned char>(c);
  return code < 0x20 || code == 0x7F;
}

/// A URL's "user:password@" is for the device alone.
std::string without_user(std::string url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) return url;
  const std::size_t begin = scheme + 3;
  const std::size_t end = std::min(url.find_first_of("/?#", begin), url.size());
  const std::size_t at = std::string_view(url).substr(0, end).rfind('@');
  if (at != std::string::npos && at >= begin) url.erase(begin, at + 1 - begin);
  return url;
}

std::string key(const std::string& name) {
  const bool is_bare = !name.empty() && name.find('.') == std::string::npos &&
                       name.find_first_not_of(kNameCharacters) == std::string::npos;
  return is_bare ? name : toml_string(name);
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
  std::string text = "\n# " + plain(without_user(sensor.source)) + ", " +
                     std::to_string(sensor.timing.delays.size()) + " measured\n[" + table + "]\n";
  text += "kind = " + toml_string(std::string(uav::name(sensor.kind))) + "\n";
  if (sensor.timing.period) {
    text += "timing = \"periodic\"\nperiod_ms = " + in_ms(*sensor.timing.period) + "\n";
  } else {
    text += "timing = \"on_demand\"\n";
  }
  return text + "\n[" + table + ".delay]\nkind = \"empirical\"\n" +
         samples_text(sensor.timing.delays);
}

}  // namespace

std::string plain(std::string_view text) {
  std::string result = in_utf8(text);
  std::replace_if(result.begin(), result.end(), is_control, '?');
  return result;
}

/// A basic string, also where a key must be quoted. Control characters are escaped, so that no two
/// keys become one.
std::string toml_string(std::string_view text) {
  static constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string result = "\"";
  for (const char c : in_utf8(text)) {
    if (is_control(c)) {
      const auto code = static_cast<unsigned char>(c);
      result += std::string("\\u00") + kHex[code / 16] + kHex[code % 16];
    } else {
      result += (c == '"' || c == '\\') ? std::string("\\") + c : std::string(1, c);
    }
  }
  return result + "\"";
}

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

Status check_delays(const MeasuredProfile& profile) {
  for (const ProfiledSensor& sensor : profile.sensors) {
    const auto& delays = sensor.timing.delays;
    const auto longest = std::max_element(delays.begin(), delays.end());
    if (longest != delays.end() && *longest > kLongestDelay) {
      return Failure{Failure::Kind::kInvalid, "sensor \"" + sensor.name + "\": a delay of " +
                                                  in_ms(*longest) +
                                                  " ms was measured; a profile can have at "
                                                  "most 60000 ms, so none is written"};
    }
  }
  return ok_status();
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
  text += "name = " + toml_string(profile.name) + "\n";
  text += "description = " + toml_string(plain(names + " as measured on " + profile.where)) + "\n";
  for (const ProfiledSensor& sensor : profile.sensors) text += sensor_text(sensor);
  return text;
}

}  // namespace tether::calibration

#include "tables/read_delay.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include <fmt/format.h>

#include <tether/os/text_file.h>

namespace tether::scenario {
namespace {

constexpr double kLongestDelay_ms = 60'000.0;
constexpr toml::Range kDelay_ms{.min = 0.0, .max = kLongestDelay_ms};
constexpr std::array<std::string_view, 3> kSampleKeys = {"samples_ms", "file_ms", "file_s"};

std::string_view trimmed(std::string_view line) {
  const auto first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

/// Some editors put this mark before the first character (TOML's parser skips it as well).
std::string without_byte_order_mark(const std::string& text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

/// The beginning of the text with everything but printable ASCII as \xHH, so that it stays on one
/// line and cannot command a terminal.
std::string printable(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string result;
  for (const char c : text.substr(0, kMost)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte >= 0x20 && byte < 0x7F;
    result += is_plain ? std::string(1, c) : fmt::format("\\x{:02X}", byte);
  }
  return text.size() > kMost ? result + "…" : result;
}

Duration parse_sample(std::string_view text, double seconds_per_unit, const FileLocation& at) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw Error(ErrorCode::kBadFile, at,
                fmt::format("expected one number on the line, found \"{}\"", printable(text)));
  }
  const toml::Range range{.min = 0.0, .max = kLongestDelay_ms * 1e-3 / seconds_per_unit};
  if (!range.contains(value)) {
    throw Error(ErrorCode::kBadFile, at,
                fmt::format("a delay must be {}, but is {}", range.text(), value));
  }
  return duration_from_seconds(value * seconds_per_unit);
}

std::vector<Duration> read_inline_samples(const toml::Table& delay) {
  std::vector<Duration> samples;
  for (const double value_ms : delay.numbers("samples_ms", kDelay_ms)) {
    samples.push_back(duration_from_seconds(value_ms * 1e-3));
  }
  return samples;
}

uav::Delay read_empirical(const toml::Table& delay, std::vector<std::filesystem::path>& files) {
  const auto given =
      std::ranges::count_if(kSampleKeys, [&](std::string_view key) { return delay.has(key); });
  if (given != 1) {
    delay.fail(
        "needs exactly one of 'samples_ms' (an array of delays), 'file_ms' and 'file_s' (a file "
        "with "
        "one delay per line in that unit).");
  }
  if (delay.has("samples_ms")) return uav::EmpiricalDelay{read_inline_samples(delay)};
  const std::string_view key = delay.has("file_ms") ? "file_ms" : "file_s";
  files.push_back(delay.existing_file(key));
  return uav::EmpiricalDelay{read_delay_samples(files.back(), key == "file_ms" ? 1e-3 : 1.0)};
}

}  // namespace

// The kind decides which keys are allowed, so it is read first, with any key allowed.
uav::Delay read_delay(const toml::Table& table, const std::string& key,
                      std::vector<std::filesystem::path>& files) {
  constexpr std::array<std::string_view, 3> kKinds = {"constant", "normal", "empirical"};
  if (!table.is_table(key))
    table.fail(key, "must be a table. Write " + key + " = { kind = \"constant\", ms = 37 }");
  switch (table.table(key).choice("kind", kKinds)) {
    case 0: {
      const toml::Table delay = table.table(key, {"kind", "ms"});
      return uav::ConstantDelay{delay.duration("ms", kDelay_ms)};
    }
    case 1: {
      const toml::Table delay = table.table(key, {"kind", "mean_ms", "stddev_ms"});
      return uav::NormalDelay{delay.duration("mean_ms", kDelay_ms),
                              delay.duration("stddev_ms", kDelay_ms)};
    }
    default:
      return read_empirical(table.table(key, {"kind", "samples_ms", "file_ms", "file_s"}), files);
  }
}

std::vector<Duration> read_delay_samples(const std::filesystem::path& file,
                                         double seconds_per_unit) {
  constexpr std::size_t kLargestFile = std::size_t{64} << 20;
  std::istringstream text(without_byte_order_mark(os::read_file(file, kLargestFile)));
  std::vector<Duration> samples;
  FileLocation at{file.string()};
  for (std::string whole_line; std::getline(text, whole_line);) {
    ++at.line;
    const std::string_view line = trimmed(whole_line);
    if (line.empty() || line.front() == '#') continue;
    samples.push_back(parse_sample(line, seconds_per_unit, at));
  }
  if (samples.empty()) {
    throw Error(ErrorCode::kBadFile, {file.string()},
                "contains no delay. Expected one number per line.");
  }
  return samples;
}

}  // namespace tether::scenario

#include "tables/report_format.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include <tether/base/text.h>

namespace tether::report {

std::string decimals(double value) {
  const std::string text = fmt::format("{:.3f}", value);
  return text == "-0.000" ? "0.000" : text;
}

std::string decimals(const std::optional<double>& value) {
  return value ? decimals(*value) : kNone;
}

std::string interval(const std::optional<campaign::Interval>& value) {
  if (!value) return kNone;
  return fmt::format("[{}, {}]", decimals(value->low), decimals(value->high));
}

std::string p_value(double p) {
  return p < 0.001 ? "< 0.001" : fmt::format("{:.3f}", p);
}

std::string exact(double value) {
  return fmt::format("{}", value);
}
std::string exact(const std::optional<double>& value) {
  return value ? exact(*value) : "";
}

bool has_crash(const campaign::TrialResult& trial) {
  return std::ranges::any_of(trial.contacts, [](const auto& own) { return own.hard > 0; });
}
std::string limit_text(const campaign::MetricValue& metric) {
  if (metric.min) return "≥ " + exact(*metric.min);
  return metric.max ? exact(*metric.max) : kNone;
}
std::string with_unit(const std::string& label, const std::string& unit) {
  return unit == "1" ? label : fmt::format("{} ({})", label, unit);
}

std::string in_a_sentence(std::string label) {
  const bool is_word = label.size() > 1 && std::islower(static_cast<unsigned char>(label[1])) != 0;
  if (is_word) label[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(label[0])));
  return label;
}

std::string capital(std::string_view text) {
  std::string with(text);
  if (!with.empty() && with[0] >= 'a' && with[0] <= 'z') with[0] = static_cast<char>(with[0] - 32);
  return with;
}

std::string share_text(double value) {
  return fmt::format("{:.0f} %", 100.0 * value);
}

std::string short_ms(double seconds) {
  if (seconds > 0.0 && seconds < 0.00095) return fmt::format("{:.2g} ms", 1e3 * seconds);
  return fmt::format("{:.{}f} ms", 1e3 * seconds, seconds < 0.01 ? 1 : 0);
}

std::string rate_text(double hz) {
  return fixed(hz, hz < 9.95 ? 1 : 0);
}

std::string distance_text(double margin) {
  if (margin == 0.0) return "at the limit";
  return fmt::format("{} {}", share_text(std::abs(margin)), margin < 0.0 ? "beyond" : "left");
}

std::string joined_with_and(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

std::string notes_of(const campaign::TrialResult& trial) {
  return fmt::format("{}", fmt::join(trial.this_run.notes, "; "));
}

std::optional<double> number_in(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::vector<Heading> single_headings(const std::vector<std::string>& texts) {
  std::vector<Heading> headings;
  for (const std::string& text : texts) headings.push_back({text, 1});
  return headings;
}

}  // namespace tether::report

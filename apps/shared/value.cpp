#include "shared/value.h"

#include <sstream>
#include <string_view>
#include <utility>

namespace tether::app {

namespace {

/// Names of options end with the unit of their number.
constexpr std::pair<std::string_view, const char*> kUnits[] = {
    {"-deg-s", "DEG/S"}, {"-rad-s", "RAD/S"}, {"-m-s", "M/S"},  {"-deg", "DEG"}, {"-px", "PX"},
    {"-ms", "MS"},       {"-s", "SECONDS"},   {"-m", "METRES"}, {"-hz", "HZ"},
};

std::string unit_of(const CLI::Option& option) {
  if (option.get_lnames().empty()) return "NUMBER";
  for (const auto& [end, unit] : kUnits)
    if (option.get_lnames().front().ends_with(end)) return unit;
  return "NUMBER";
}

}  // namespace

Value value_of(const CLI::Option& option) {
  // The name of the type, then after ":" what its checks say: `within`, or CLI::IsMember.
  const std::string type = option.get_type_name();
  const std::size_t colon = type.find(':');
  Value value{.word = type.substr(0, colon)};
  const std::string checks = colon == std::string::npos ? "" : type.substr(colon + 1);
  value.is_whole = value.word == "UINT" || value.word == "INT";
  if (value.is_whole || value.word == "FLOAT") value.word = unit_of(option);
  if (value.word == "BOOLEAN") value.word = "true|false";
  if (!checks.starts_with('{')) {
    for (const char c : checks) value.range += c == ':' ? std::string(", ") : std::string(1, c);
    return value;
  }
  std::istringstream choices(checks.substr(1, checks.find('}') - 1));
  value.word.clear();
  for (std::string choice; std::getline(choices, choice, ',');) {
    value.word += (value.choices.empty() ? "" : "|") + choice;
    value.choices.push_back(choice);
  }
  return value;
}

std::pair<std::string, std::string> split_default(const std::string& text) {
  const std::size_t bracket = text.rfind(" [");
  if (!text.ends_with(']') || bracket == std::string::npos) return {text, ""};
  return {text.substr(0, bracket), text.substr(bracket + 2, text.size() - bracket - 3)};
}

std::string text_of(const CLI::Option& option) {
  const Value value = value_of(option);
  auto [text, preset] = split_default(option.get_description());
  if (!value.range.empty())
    text += (text.ends_with('.') ? " A " : ". A ") + std::string(value.is_whole ? "whole " : "") +
            "number from " + value.range;
  if (preset.empty()) preset = option.get_default_str();
  if (value.word == "true|false")
    preset = preset == "0" ? "false" : preset == "1" ? "true" : preset;
  if (!preset.empty()) text += " [" + preset + "]";
  return text;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() != 0;
}

bool is_list(const CLI::Option& option) {
  return option.get_expected_max() == CLI::detail::expected_max_vector_size;
}

std::vector<const CLI::App*> subcommands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

}  // namespace tether::app

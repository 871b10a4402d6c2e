#include "shared/command.h"

#include "shared/within.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

#include <tether/base/text.h>

namespace tether::app {

namespace {

/// With what is wrong as CLI11 wants it.
template <class Value>
CLI::Option* add_function(CLI::App& command, const std::string& key,
                          const std::function<void(const Value&)>& function) {
  return command.add_option_function<Value>(key, [key, function](const Value& value) {
    try {
      function(value);
    } catch (const std::invalid_argument& wrong) {
      throw CLI::ValidationError(key, wrong.what());
    }
  });
}

/// Adds an option that sets what a pointer leads to, or calls a function.
struct Adding {
  CLI::App& command;
  std::string key, value;
  bool shows_default;

  template <class Value>
  CLI::Option* operator()(Value* to) const {
    CLI::Option* option = command.add_option(key, *to);
    constexpr bool kHasText = std::is_arithmetic_v<Value> || std::is_same_v<Value, std::string>;
    if (kHasText && shows_default) option->capture_default_str();
    return option;
  }
  CLI::Option* operator()(bool* to) const {
    if (value.empty()) return command.add_flag(key, *to);
    return command.add_option(key, *to)->capture_default_str();
  }
  CLI::Option* operator()(const std::function<void(double)>& function) const {
    return add_function<double>(command, key, function);
  }
  CLI::Option* operator()(const std::function<void(const std::string&)>& function) const {
    return add_function<std::string>(command, key, function);
  }
  CLI::Option* operator()(const std::function<void(const std::vector<double>&)>& function) const {
    return add_function<std::vector<double>>(command, key, function);
  }
};

/// Suggests the nearest word to one that is not allowed.
CLI::Validator one_of_these(const std::vector<std::string>& words) {
  const auto wrong = [words](const std::string& text) -> std::string {
    if (std::ranges::count(words, text) > 0) return "";
    const std::vector<std::string_view> allowed(words.begin(), words.end());
    return "cannot be '" + text + "'; " + allowed_hint(text, allowed);
  };
  return {wrong, "{" + CLI::detail::join(words, ",") + "}", ""};
}

void limit(CLI::Option& option, const Allowed& allowed) {
  if (std::isfinite(allowed.least)) option.check(within(allowed.least, allowed.most));
  if (!allowed.words.empty()) option.check(one_of_these(allowed.words));
  if (allowed.check)
    option.check(CLI::Validator([check = allowed.check](auto& text) { return check(text); }, ""));
  if (allowed.is_required) option.required();
  if (allowed.follows_dashes)
    option.check(CLI::Validator(
        [](auto& text) { return "unexpected argument '" + text + "'; it has to follow '--'"; },
        ""));
  if (allowed.is_one_each) option.expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  if (allowed.has_commas) option.delimiter(',');
  if (allowed.count > 0) option.expected(allowed.count);
  if (!allowed.usual.empty()) option.default_str(allowed.usual);
}

}  // namespace

Allowed range(double least, double most) {
  return {.least = least, .most = most};
}

Allowed one_of(std::vector<std::string> words) {
  return {.words = std::move(words)};
}

Allowed required() {
  return {.is_required = true};
}

Allowed checked(std::function<std::string(const std::string&)> check) {
  return {.check = std::move(check)};
}

std::string key_of(const Option& option) {
  return option.words.substr(0, option.words.find(' '));
}

Options concatenated(std::vector<Options> groups) {
  Options all;
  for (Options& group : groups) std::ranges::move(group, std::back_inserter(all));
  return all;
}

void add_options(CLI::App& command, const Options& options) {
  for (const Option& row : options) {
    const std::string key = key_of(row);
    const std::string value = row.words.substr(std::min(key.size() + 1, row.words.size()));
    CLI::Option* option =
        std::visit(Adding{command, key, value, !row.allowed.is_required}, row.destination);
    option->description(row.help);
    if (!value.empty()) option->type_name(value);
    limit(*option, row.allowed);
  }
}

CLI::App* add_command(CLI::App& program, const std::string& words, const std::string& help,
                      const Options& options, const std::string& footer) {
  const std::size_t blank = words.find(' ');
  if (blank != std::string::npos)
    return add_command(*program.get_subcommand(words.substr(0, blank)), words.substr(blank + 1),
                       help, options, footer);
  CLI::App* command = program.add_subcommand(words, help);
  add_options(*command, options);
  command->footer(footer);
  return command;
}

}  // namespace tether::app

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>

#include <tether/client/exec/computed.h>

namespace tether::client {
namespace {

std::string_view last_part(std::string_view path) {
  return path.substr(path.rfind('/') + 1);
}

/// What needs no escape in JSON; others are '?'.
std::string plain(std::string_view text) {
  std::string result(text);
  std::ranges::replace_if(
      result, [](char c) { return c < ' ' || c > '~' || c == '"' || c == '\\'; }, '?');
  return result;
}

}  // namespace

std::string details_of(const Computed& computed) {
  std::string parts;
  for (const auto& [name, duration] : computed) {
    if (duration < std::chrono::milliseconds(10)) continue;
    char number[32];
    std::snprintf(number, sizeof number, "%.3f", std::chrono::duration<double>(duration).count());
    parts += (parts.empty() ? "\"" : ", \"") + plain(name) + "\": " + number;
  }
  return "{\"computed_s\": {" + parts + "}}";
}

std::string process_name(std::string_view arguments) {
  const auto take = [&arguments] {
    const std::string_view word = arguments.substr(0, arguments.find('\0'));
    arguments.remove_prefix(std::min(arguments.size(), word.size() + 1));
    return word;
  };
  std::string name(last_part(take()));
  const std::string_view script = take();
  const std::size_t dot = script.rfind('.');
  const bool has_ending = dot < script.size() - 1 && std::isalpha(script[dot + 1]) != 0;
  if (!script.starts_with('-') && (has_ending || script.find('/') != script.npos))
    name += " " + std::string(last_part(script));
  return name;
}

}  // namespace tether::client

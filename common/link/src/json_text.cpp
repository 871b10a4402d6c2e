#include "json_text.h"

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include <tether/base/text.h>

namespace tether::link {
namespace {

using Json = nlohmann::json;

/// Accepts every value and keeps only the position at which the reader stopped.
struct FaultHandler {
  std::size_t bytes_read = 0;

  bool null() { return true; }
  bool boolean(bool) { return true; }
  bool number_integer(Json::number_integer_t) { return true; }
  bool number_unsigned(Json::number_unsigned_t) { return true; }
  bool number_float(Json::number_float_t, const std::string&) { return true; }
  bool string(std::string&) { return true; }
  bool binary(Json::binary_t&) { return true; }
  bool start_object(std::size_t) { return true; }
  bool key(std::string&) { return true; }
  bool end_object() { return true; }
  bool start_array(std::size_t) { return true; }
  bool end_array() { return true; }
  bool parse_error(std::size_t position, const std::string&, const Json::exception&) {
    bytes_read = position;
    return false;
  }
};

/// The text from a position on, shortened and printable.
std::string excerpt(const std::string& text, std::size_t at) {
  constexpr std::size_t kLength = 24;
  std::string found = text.substr(at, kLength);
  for (char& c : found)
    if (c < ' ' || c > '~') c = '?';
  return found.empty() ? "its end" : "\"" + found + "\"";
}

}  // namespace

std::optional<std::size_t> fault_of_json_object(std::string_view text) {
  // The reader also accepts other values and a byte order mark, and ends at a NUL byte.
  const std::size_t begin = text.find_first_not_of(" \t\n\r");
  if (begin == std::string_view::npos || text[begin] != '{') return std::min(begin, text.size());
  const std::string_view before_zero = text.substr(0, text.find('\0'));
  FaultHandler handler;
  if (!Json::sax_parse(before_zero.begin(), before_zero.end(), &handler))
    return handler.bytes_read - 1;
  if (before_zero.size() < text.size()) return before_zero.size();
  return std::nullopt;
}

std::string complaint_about_json(const std::string& text) {
  if (json_depth(text) > kMaxSutJsonDepth)
    return "is nested deeper than " + std::to_string(kMaxSutJsonDepth) + " levels";
  const auto fault = fault_of_json_object(text);
  if (!fault) return "";
  return "is not a JSON object: fault at byte " + std::to_string(*fault) + ", " +
         excerpt(text, *fault);
}

}  // namespace tether::link

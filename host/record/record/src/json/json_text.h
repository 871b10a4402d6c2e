#pragma once

#include <charconv>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Writing JSON straight into a buffer: a record has a message per interaction, written inside the
/// coordinator's loop.
namespace tether::record {

/// A quoted JSON string. Bytes that are not UTF-8 become U+FFFD.
void append_json_string(std::string& out, std::string_view text);
/// The text with each byte that is not UTF-8 replaced by U+FFFD.
std::string to_utf8(std::string_view text);
/// The shortest text that reads back as the same double; `null` when it is not finite.
void append_json_number(std::string& out, double value);

template <std::integral Integer>
void append_json_integer(std::string& out, Integer value) {
  char text[24];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  out.append(text, end);
}

/// One object, member by member. `close` ends it. Names are our own and need no escaping.
class JsonObject {
 public:
  explicit JsonObject(std::string& out) : out_(out) { out_ += '{'; }

  void text(std::string_view name, std::string_view value) {
    begin(name);
    append_json_string(out_, value);
  }
  template <std::integral Integer>
  void integer(std::string_view name, Integer value) {
    begin(name);
    append_json_integer(out_, value);
  }
  void number(std::string_view name, double value) {
    begin(name);
    append_json_number(out_, value);
  }
  void boolean(std::string_view name, bool value) {
    begin(name);
    out_ += value ? "true" : "false";
  }
  void numbers(std::string_view name, std::span<const double> values);
  /// JSON text as it is.
  void raw(std::string_view name, std::string_view json) {
    begin(name);
    out_ += json;
  }
  /// A member object, to be closed before the next member.
  JsonObject object(std::string_view name) {
    begin(name);
    return JsonObject(out_);
  }
  /// Starts a member; its value is appended by the caller.
  std::string& begin(std::string_view name) {
    if (!first_) out_ += ',';
    first_ = false;
    out_ += '"';
    out_ += name;
    out_ += "\":";
    return out_;
  }
  void close() { out_ += '}'; }

 private:
  std::string& out_;
  bool first_ = true;
};

/// Base64 (RFC 4648, with padding).
void append_base64(std::string& out, std::span<const std::uint8_t> bytes);
/// Appends the decoded bytes; false if `text` is not base64.
bool decode_base64(std::string_view text, std::vector<std::uint8_t>& out);

}  // namespace tether::record

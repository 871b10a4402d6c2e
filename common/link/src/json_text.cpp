#include "json_text.h"

#include <cstddef>

#include <tether/link/codec.h>

namespace tether::link {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The value of a hexadecimal digit; -1: it is none.
int hex_value(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// Takes the grammar's pieces from the front of a text; false: it does not go on with such a piece.
/// What was taken then of it stays taken: that is where the fault is.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  bool is_whole_object() {
    blanks();
    const bool is_object = front() == '{' && value(0);
    blanks();
    return is_object && rest_.empty();
  }

  /// Bytes that were not taken.
  std::size_t left() const { return rest_.size(); }

 private:
  /// A zero byte at the end; nothing takes one.
  char front() const { return rest_.empty() ? '\0' : rest_.front(); }

  bool take(char c) {
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool take(std::string_view word) {
    if (rest_.substr(0, word.size()) != word) return false;
    rest_.remove_prefix(word.size());
    return true;
  }

  void blanks() {
    while (take(' ') || take('\t') || take('\n') || take('\r')) {
    }
  }

  /// Recurses no deeper than kMaxJsonDepth.
  bool value(int depth) {
    const bool is_list = front() == '{' || front() == '[';
    if (is_list) return depth < kMaxJsonDepth && (front() == '{' ? object(depth) : array(depth));
    return front() == '"' ? string() : take("true") || take("false") || take("null") || number();
  }

  bool object(int depth) {
    take('{');
    blanks();
    if (take('}')) return true;
    do {
      blanks();
      if (!member(depth)) return false;
      blanks();
    } while (take(','));
    return take('}');
  }

  bool member(int depth) {
    if (!string()) return false;
    blanks();
    if (!take(':')) return false;
    blanks();
    return value(depth + 1);
  }

  bool array(int depth) {
    take('[');
    blanks();
    if (take(']')) return true;
    do {
      blanks();
      if (!value(depth + 1)) return false;
      blanks();
    } while (take(','));
    return take(']');
  }

  bool number() {
    take('-');
    if (!take('0') && !digits()) return false;
    if (take('.') && !digits()) return false;
    if (!take('e') && !take('E')) return true;
    if (!take('+')) take('-');
    return digits();
  }

  bool digits() {
    std::size_t count = 0;
    while (count < rest_.size() && is_digit(rest_[count])) ++count;
    rest_.remove_prefix(count);
    return count > 0;
  }

  bool string() {
    if (!take('"')) return false;
    while (!take('"'))
      if (rest_.empty() || !(front() == '\\' ? escape() : character())) return false;
    return true;
  }

  bool character() {
    const auto byte = static_cast<unsigned char>(front());
    if (byte >= 0x80) return multibyte();
    rest_.remove_prefix(1);
    return byte >= 0x20;
  }

  /// One character beyond ASCII (RFC 3629).
  bool multibyte() {
    const auto lead = static_cast<unsigned char>(rest_[0]);
    const auto second = static_cast<unsigned char>(rest_.size() > 1 ? rest_[1] : '\0');
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    const bool is_overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
    const bool is_surrogate = lead == 0xED && second >= 0xA0;
    const bool is_beyond = lead > 0xF4 || (lead == 0xF4 && second >= 0x90);
    if (lead < 0xC2 || is_overlong || is_surrogate || is_beyond) return false;
    if (rest_.size() < length) return false;
    for (std::size_t i = 1; i < length; ++i)
      if ((static_cast<unsigned char>(rest_[i]) & 0xC0) != 0x80) return false;
    rest_.remove_prefix(length);
    return true;
  }

  bool escape() {
    take('\\');
    if (take('u')) return code_point();
    const bool is_known = std::string_view("\"\\/bfnrt").find(front()) != std::string_view::npos;
    if (!rest_.empty()) rest_.remove_prefix(1);
    return is_known;
  }

  /// Four hexadecimal digits; half of a pair comes with its other half.
  bool code_point() {
    const int first = code_unit();
    if (first < 0xD800 || first > 0xDFFF) return first >= 0;
    if (first > 0xDBFF || !take("\\u")) return false;
    const int second = code_unit();
    return second >= 0xDC00 && second <= 0xDFFF;
  }

  /// -1: it is none.
  int code_unit() {
    if (rest_.size() < 4) return -1;
    int unit = 0;
    for (const char c : rest_.substr(0, 4)) {
      const int digit = hex_value(c);
      if (digit < 0) return -1;
      unit = unit * 16 + digit;
    }
    rest_.remove_prefix(4);
    return unit;
  }

  std::string_view rest_;
};

}  // namespace

std::optional<std::size_t> fault_of_json_object(std::string_view text) {
  Scanner scanner(text);
  if (scanner.is_whole_object()) return std::nullopt;
  return text.size() - scanner.left();
}

}  // namespace tether::link

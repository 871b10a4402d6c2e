#include <charconv>

#include <tether/base/text.h>

namespace tether {
namespace {

unsigned byte_at(const std::string& text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
}

}  // namespace

std::string printable(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned byte = byte_at(text, i), next = byte_at(text, i + 1);
    // U+0080 to U+009F steer terminals too.
    const bool is_second_set = byte == 0xC2 && next >= 0x80 && next < 0xA0;
    if (is_second_set) ++i;
    out += is_second_set || byte < 0x20 || byte == 0x7F ? '?' : text[i];
  }
  const auto begin = out.find_first_not_of(' '), end = out.find_last_not_of(' ');
  return begin == std::string::npos ? "" : out.substr(begin, end - begin + 1);
}

std::string counted(std::size_t count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string unescaped(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned code = static_cast<unsigned char>(uri[i]);
    if (uri[i] == '%' && i + 2 < uri.size()) {
      const char* begin = uri.data() + i + 1;
      if (std::from_chars(begin, begin + 2, code, 16).ptr == begin + 2) i += 2;
    }
    text += static_cast<char>(code);
  }
  return text;
}

}  // namespace tether

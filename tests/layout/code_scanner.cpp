#include "code_scanner.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace tether::layout {
namespace {

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Copies a source while blanking what is no code.
class Stripper {
 public:
  explicit Stripper(std::string_view source) : source_(source), out_(source) {}

  std::string run() {
    while (at_ < source_.size()) step();
    return std::move(out_);
  }

 private:
  bool starts_with(std::string_view text) const { return source_.substr(at_).starts_with(text); }

  void step() {
    if (starts_with("//")) {
      blank_until(source_.find('\n', at_));
    } else if (starts_with("/*")) {
      blank_until(after(source_.find("*/", at_ + 2), 2));
    } else if (starts_with("R\"") && !inside_word()) {
      raw_string();
    } else if (source_[at_] == '"') {
      literal('"');
    } else if (source_[at_] == '\'' && !is_digit_separator()) {
      literal('\'');
    } else {
      ++at_;
    }
  }

  /// A quote inside a number, as in 1'000. Encoding prefixes of literals (u8'a', L'a') begin with a
  /// letter.
  bool is_digit_separator() const {
    std::size_t begin = at_;
    while (begin > 0 && (is_word(source_[begin - 1]) || source_[begin - 1] == '\'')) --begin;
    return begin < at_ && std::isdigit(static_cast<unsigned char>(source_[begin])) != 0;
  }
  bool inside_word() const {
    return at_ > 0 && is_word(source_[at_ - 1]) &&
           source_.substr(0, at_).find_last_of("uUL8") != at_ - 1;
  }

  void literal(char quote) {
    std::size_t end = at_ + 1;
    while (end < source_.size() && source_[end] != quote && source_[end] != '\n') {
      end += source_[end] == '\\' ? 2U : 1U;
    }
    ++at_;
    blank_until(std::min(end, source_.size()));
    if (at_ < source_.size()) ++at_;
  }

  void raw_string() {
    const std::size_t open = source_.find('(', at_);
    if (open == std::string_view::npos) return blank_until(open);
    const std::string close = ")" + std::string(source_.substr(at_ + 2, open - at_ - 2)) + "\"";
    blank_until(after(source_.find(close, open), close.size()));
  }

  static std::size_t after(std::size_t found, std::size_t length) {
    return found == std::string_view::npos ? found : found + length;
  }

  void blank_until(std::size_t end) {
    for (end = std::min(end, source_.size()); at_ < end; ++at_) {
      if (source_[at_] != '\n') out_[at_] = ' ';
    }
  }

  std::string_view source_;
  std::string out_;
  std::size_t at_ = 0;
};

}  // namespace

std::string strip(std::string_view source) {
  return Stripper(source).run();
}

std::vector<Include> includes(std::string_view source) {
  // Blanking literals would blank quoted paths too, so directives are found in the stripped text
  // and read in the source.
  const std::string stripped = strip(source);
  std::vector<Include> found;
  int line = 0;
  for (std::size_t begin = 0; begin < source.size();) {
    ++line;
    const std::size_t end = std::min(source.find('\n', begin), source.size());
    const std::string_view code = trim(std::string_view(stripped).substr(begin, end - begin));
    const std::string_view text = source.substr(begin, end - begin);
    begin = end + 1;
    if (!code.starts_with('#') || !trim(code.substr(1)).starts_with("include")) continue;
    const std::size_t open = text.find_first_of("<\"");
    if (open == std::string_view::npos) continue;
    const bool quoted = text[open] == '"';
    const std::size_t close = text.find(quoted ? '"' : '>', open + 1);
    found.push_back({line, std::string(text.substr(open + 1, close - open - 1)), quoted});
  }
  return found;
}

std::vector<int> lines_with_word(std::string_view stripped, std::string_view word) {
  std::vector<int> lines;
  int line = 1;
  std::size_t counted = 0;
  for (std::size_t at = stripped.find(word); at != std::string_view::npos;
       at = stripped.find(word, at + 1)) {
    line += static_cast<int>(std::count(stripped.begin() + static_cast<std::ptrdiff_t>(counted),
                                        stripped.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    counted = at;
    const bool open_before = at == 0 || !is_word(stripped[at - 1]);
    const std::size_t end = at + word.size();
    if (open_before && (end == stripped.size() || !is_word(stripped[end]))) lines.push_back(line);
  }
  return lines;
}

int count_lines(std::string_view source) {
  const auto breaks = static_cast<int>(std::count(source.begin(), source.end(), '\n'));
  return breaks + (source.empty() || source.back() == '\n' ? 0 : 1);
}

}  // namespace tether::layout

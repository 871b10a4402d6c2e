#include <algorithm>
#include <charconv>
#include <clocale>
#include <cstdlib>
#include <cwchar>
#include <string_view>
#include <system_error>

#include <sys/ioctl.h>
#include <unistd.h>

#include <tether/os/terminal.h>

namespace tether::os {
namespace {

constexpr int kUsualColumns = 80;

/// UTF-8 for this thread, whatever the user's locale is, while it lives.
class Utf8 {
 public:
  Utf8() : utf8_(newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)) {
    if (utf8_) before_ = uselocale(utf8_);
  }
  ~Utf8() {
    if (!utf8_) return;
    uselocale(before_);
    freelocale(utf8_);
  }
  Utf8(const Utf8&) = delete;
  Utf8& operator=(const Utf8&) = delete;

 private:
  locale_t utf8_;
  locale_t before_ = nullptr;
};

/// Empty: it is not set.
std::string_view variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

struct Prefix {
  std::size_t bytes = 0;
  int columns = 0;
};

/// The longest one of at most `columns`. A byte that is no UTF-8 counts as one column.
Prefix longest_prefix(const std::string& text, int columns) {
  const Utf8 utf8;
  Prefix prefix;
  while (prefix.bytes < text.size()) {
    wchar_t character = 0;
    std::mbstate_t state{};
    const std::size_t got =
        std::mbrtowc(&character, text.data() + prefix.bytes, text.size() - prefix.bytes, &state);
    const bool is_character = got > 0 && got <= text.size();
    const int width = is_character ? std::max(0, wcwidth(character)) : 1;
    if (prefix.columns + width > columns) break;
    prefix.bytes += is_character ? got : 1;
    prefix.columns += width;
  }
  return prefix;
}

}  // namespace

int terminal_columns(int descriptor) {
  if (isatty(descriptor) != 1) return 0;
  winsize size{};
  if (ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsualColumns;
  return size.ws_col;
}

std::size_t text_columns(int descriptor) {
  constexpr std::size_t kLeast = 20, kOfFiles = 100;
  const std::string_view given = variable("COLUMNS");
  std::size_t columns = 0;
  const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), columns);
  const bool is_number = error == std::errc() && end == given.data() + given.size();
  if (is_number && columns >= kLeast) return columns;
  const int shown = terminal_columns(descriptor);
  return shown > 0 ? std::max(static_cast<std::size_t>(shown), kLeast) : kOfFiles;
}

bool shows_colours(int descriptor) {
  return isatty(descriptor) == 1 && variable("NO_COLOR").empty() && variable("TERM") != "dumb";
}

std::string cut_to_columns(const std::string& text, int columns) {
  if (longest_prefix(text, columns - 1).bytes == text.size()) return text;
  if (columns < 2) return "";
  return text.substr(0, longest_prefix(text, columns - 2).bytes) + "…";
}

std::string fields_in_columns(const std::vector<std::string>& fields, int columns) {
  std::string line;
  for (const std::string& field : fields) {
    if (field.empty()) continue;
    if (line.empty()) {
      line = cut_to_columns(field, columns);
      continue;
    }
    const std::string longer = line + "  " + field;
    if (longest_prefix(longer, columns - 1).bytes < longer.size()) break;
    line = longer;
  }
  return line;
}

}  // namespace tether::os

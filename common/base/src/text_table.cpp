#include <algorithm>
#include <charconv>
#include <iomanip>
#include <locale>
#include <sstream>

#include <tether/base/text_table.h>

namespace tether {
namespace {

constexpr std::size_t kLeftAligned = 2;

/// Characters, not bytes: the continuation bytes of UTF-8 take no room.
std::size_t width(const std::string& cell) {
  return static_cast<std::size_t>(std::count_if(cell.begin(), cell.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }));
}

std::string line_of(const std::vector<std::string>& row, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string room(widths[i] - width(row[i]), ' ');
    line += (i == 0 ? "" : "  ") + (i < kLeftAligned ? row[i] + room : room + row[i]);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], width(row[i]));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    text += line_of(row, widths);
  }
  return text;
}

std::string fixed(double value, int digits) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string distinct_text(double value, double other, int digits) {
  constexpr int kAll = 17;
  const auto text = [&](double number) {
    char buffer[40];
    const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, number,
                                            std::chars_format::general, digits);
    return std::string(buffer, end);
  };
  while (value != other && digits < kAll && text(value) == text(other)) ++digits;
  return text(value);
}

}  // namespace tether

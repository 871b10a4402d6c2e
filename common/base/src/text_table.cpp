#include <algorithm>
#include <iomanip>
#include <locale>
#include <sstream>

#include <tether/base/text.h>

namespace tether {
namespace {

constexpr std::size_t kLeftAligned = 2;

std::string line_of(const std::vector<std::string>& row, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string room(widths[i] - columns_of(row[i]), ' ');
    line += (i == 0 ? "" : "  ") + (i < kLeftAligned ? row[i] + room : room + row[i]);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

/// Where the text of a line begins: behind its indent, and behind a mark or a label.
std::size_t text_begin(const std::string& line) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  for (const std::string mark : {"→ ", "- "})
    if (line.compare(indent, mark.size(), mark) == 0) return indent + mark.size();
  const std::size_t gap = line.find("  ", indent);
  return gap == std::string::npos ? indent
                                  : std::min(line.find_first_not_of(' ', gap), line.size());
}

/// @param line longer than `columns`
std::string wrapped_line(const std::string& line, std::size_t columns) {
  std::size_t begin = text_begin(line);
  std::string out = line.substr(0, begin);
  std::size_t used = columns_of(out), hang = used;
  // The first word of a line stays, however long it is; but not behind a long label.
  bool stays = hang <= columns / 2, is_first = true;
  if (!stays) hang = std::min(line.find_first_not_of(' ') + 2, columns / 2);
  while (begin < line.size()) {
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    const std::string word = line.substr(begin, end - begin);
    const std::size_t width = columns_of(word), gap = is_first ? 0 : 1;
    if (!stays && used + gap + width > columns) {
      out.erase(out.find_last_not_of(' ') + 1);
      out += "\n" + std::string(hang, ' ');
      used = hang;
    } else {
      out.append(gap, ' ');
      used += gap;
    }
    out += word;
    used += width;
    stays = is_first = false;
    begin = std::min(line.find_first_not_of(' ', end), line.size());
  }
  return out;
}

}  // namespace

std::size_t columns_of(const std::string& text) {
  std::size_t columns = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\x1b')
      i = std::min(text.find('m', i), text.size());
    else if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U)  // UTF-8 goes on in others
      ++columns;
  }
  return columns;
}

std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t columns) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], columns_of(row[i]));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    const std::string line = line_of(row, widths);
    if (columns_of(line) - 1 > columns)
      return text_lists(rows.front(), {rows.begin() + 1, rows.end()}, columns);
    text += line;
  }
  return text;
}

std::string text_lists(const std::vector<std::string>& headings,
                       const std::vector<std::vector<std::string>>& rows, std::size_t columns) {
  std::size_t width = 0;
  for (std::size_t i = 1; i < headings.size(); ++i)
    width = std::max(width, columns_of(headings[i]));
  std::string text;
  for (const auto& row : rows) {
    if (!text.empty()) text += '\n';
    text += row.front() + '\n';
    for (std::size_t i = 1; i < row.size() && i < headings.size(); ++i) {
      if (row[i].empty()) continue;
      const std::string room(width - columns_of(headings[i]), ' ');
      text += "  " + headings[i] + room + "  " + row[i] + '\n';
    }
  }
  return wrapped(text, columns);
}

std::string wrapped(const std::string& text, std::size_t columns) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    out += columns_of(line) > columns ? wrapped_line(line, columns) : line;
    if (end < text.size()) out += '\n';
    at = end + 1;
  }
  return out;
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
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << std::setprecision(digits) << number;
    return out.str();
  };
  while (value != other && digits < kAll && text(value) == text(other)) ++digits;
  return text(value);
}

}  // namespace tether

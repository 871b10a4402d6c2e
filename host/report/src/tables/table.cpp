#include <algorithm>
#include <numeric>

#include <tether/base/text.h>
#include <tether/report/table.h>

// Three forms of a table. Text is aligned by the widths of all columns; Markdown and CSV have one
// row of headings, in which each joins all headings above its column.
namespace tether::report {
namespace {

constexpr std::size_t kGap = 2;

std::string padding(const std::string& text, std::size_t width) {
  const std::size_t used = tether::columns_of(text);
  return std::string(width > used ? width - used : 0, ' ');
}

std::string left(const std::string& text, std::size_t width) {
  return text + padding(text, width);
}
std::string right(const std::string& text, std::size_t width) {
  return padding(text, width) + text;
}

std::size_t column_count(const Table& table) {
  std::size_t count = 0;
  if (!table.headings.empty()) {
    for (const Heading& heading : table.headings.front()) count += heading.columns;
  }
  for (const auto& row : table.rows) count = std::max(count, row.size());
  return count;
}

std::size_t span_width(const std::vector<std::size_t>& widths, std::size_t first,
                       std::size_t columns) {
  const auto begin = widths.begin() + static_cast<std::ptrdiff_t>(first);
  const std::size_t sum =
      std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(columns), std::size_t{0});
  return sum + kGap * (columns - 1);
}

// First by the cells and narrow headings; then a wide heading widens the last column below it.
std::vector<std::size_t> column_widths(const Table& table) {
  std::vector<std::size_t> widths(column_count(table), 0);
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], tether::columns_of(row[i]));
  }
  for (auto row = table.headings.rbegin(); row != table.headings.rend(); ++row) {
    std::size_t first = 0;
    for (const Heading& heading : *row) {
      const std::size_t have = span_width(widths, first, heading.columns);
      const std::size_t need = tether::columns_of(heading.text);
      if (need > have) widths[first + heading.columns - 1] += need - have;
      first += heading.columns;
    }
  }
  return widths;
}

std::string trimmed_line(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string heading_line(const std::vector<Heading>& row, const std::vector<std::size_t>& widths,
                         std::size_t text_columns) {
  std::string line;
  std::size_t first = 0;
  for (const Heading& heading : row) {
    const std::size_t width = span_width(widths, first, heading.columns);
    const bool to_the_left = first < text_columns || heading.columns > 1;
    if (first > 0) line.append(kGap, ' ');
    line += to_the_left ? left(heading.text, width) : right(heading.text, width);
    first += heading.columns;
  }
  return trimmed_line(line);
}

std::string row_line(const std::vector<std::string>& row, const std::vector<std::size_t>& widths,
                     std::size_t text_columns) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line.append(kGap, ' ');
    line += i < text_columns ? left(row[i], widths[i]) : right(row[i], widths[i]);
  }
  return trimmed_line(line);
}

// "Oscillations, measured, mean": one heading per column.
std::vector<std::string> joined_headings(const Table& table) {
  std::vector<std::string> joined(column_count(table));
  for (const auto& row : table.headings) {
    std::size_t column = 0;
    for (const Heading& heading : row) {
      for (std::size_t i = 0; i < heading.columns; ++i, ++column) {
        if (heading.text.empty()) continue;
        joined[column] += (joined[column].empty() ? "" : ", ") + heading.text;
      }
    }
  }
  return joined;
}

std::string escaped_markdown(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|' || c == '\\') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

std::string escaped_csv(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string escaped = "\"";
  for (const char c : text) {
    if (c == '"') escaped += '"';
    escaped += c;
  }
  return escaped + "\"";
}

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + escaped_markdown(cell) + " |";
  return line + "\n";
}

std::string csv_row(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i > 0 ? "," : "") + escaped_csv(cells[i]);
  return line + "\r\n";
}

/// Headings, a rule and the rows.
std::string aligned_text(const Table& table, const std::vector<std::size_t>& widths) {
  std::string text;
  for (const auto& row : table.headings) {
    const std::string line = heading_line(row, widths, table.text_columns);
    if (line != "\n") text += line;
  }
  if (!widths.empty()) {
    for (std::size_t i = 0; i < span_width(widths, 0, widths.size()); ++i) text += "─";
    text += "\n";
  }
  for (const auto& row : table.rows) text += row_line(row, widths, table.text_columns);
  return text;
}

}  // namespace

std::string to_text(const Table& table, std::size_t columns) {
  const std::vector<std::size_t> widths = column_widths(table);
  std::string text = table.title.empty() ? "" : table.title + "\n\n";
  if (!widths.empty() && span_width(widths, 0, widths.size()) > columns) {
    text += text_lists(joined_headings(table), table.rows, columns);
  } else {
    text += aligned_text(table, widths);
  }
  if (!table.notes.empty()) text += "\n";
  for (const std::string& note : table.notes) text += note + "\n";
  return text;
}

std::string to_markdown(const Table& table) {
  const std::vector<std::string> headings = joined_headings(table);
  std::string text = table.title.empty() ? "" : "### " + table.title + "\n\n";
  text += markdown_row(headings) + "|";
  for (std::size_t i = 0; i < headings.size(); ++i)
    text += i < table.text_columns ? ":---|" : "---:|";
  text += "\n";
  for (const auto& row : table.rows) text += markdown_row(row);
  for (const std::string& note : table.notes) text += "\n" + note + "\n";
  return text;
}

std::string to_csv(const Table& table) {
  std::string text = csv_row(joined_headings(table));
  for (const auto& row : table.rows) text += csv_row(row);
  return text;
}

}  // namespace tether::report

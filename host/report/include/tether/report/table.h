#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <tether/base/text.h>

/// Tables for people and programs.
namespace tether::report {

/// One heading over one or more columns.
struct Heading {
  std::string text;
  std::size_t columns = 1;
};

struct Table {
  std::string title;
  std::vector<std::vector<Heading>> headings;  ///< from the top; each row spans all columns
  std::vector<std::vector<std::string>> rows;  ///< each as wide as the headings
  std::vector<std::string> notes;              ///< lines below the table
  std::size_t text_columns = 1;  ///< number of leading columns with text; the others have numbers
};

/// Columns aligned for a terminal: text to the left, numbers to the right. Supports UTF-8. A table
/// that is wider than `columns` becomes a list with a block for each row.
std::string to_text(const Table& table, std::size_t columns = kAnyColumns);
/// GitHub's Markdown. The rows of headings are joined into one.
std::string to_markdown(const Table& table);
/// RFC 4180, without title and notes. The rows of headings are joined into one.
std::string to_csv(const Table& table);

}  // namespace tether::report

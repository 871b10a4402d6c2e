#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Reads C++ that clang-format has formatted, well enough to check the repository's own rules on
/// it. Lines are numbered from 1.
namespace tether::layout {

struct Include {
  int line = 0;
  std::string path;     ///< as written between the brackets or quotes
  bool quoted = false;  ///< "…" rather than <…>
};

/// The text with comments, and the contents of string and character literals, turned into blanks;
/// line breaks stay.
std::string strip(std::string_view source);

/// Every #include, in order. Ignores those in comments.
std::vector<Include> includes(std::string_view source);

/// Lines on which `word` stands by itself (no letter, digit or underscore beside it) in stripped
/// text.
std::vector<int> lines_with_word(std::string_view stripped, std::string_view word);

int count_lines(std::string_view source);

}  // namespace tether::layout

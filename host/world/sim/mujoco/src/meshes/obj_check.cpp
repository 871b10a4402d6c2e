#include "meshes/obj_check.h"

#include <algorithm>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

constexpr std::string_view kBlank = " \t\r\v\f";

/// The next word of a line; empty: there is none.
std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

/// "7", "7/1", "7//3", "-1/-1/-1".
bool is_corner(std::string_view word) {
  const bool is_made_of_digits = word.find_first_not_of("0123456789/-") == std::string_view::npos;
  return is_made_of_digits && word.front() != '/' && word.back() != '-';
}

}  // namespace

void check_obj(std::string_view content, const std::filesystem::path& file) {
  bool continues = false, is_element = false;
  for (int number = 1; !content.empty(); ++number) {
    std::string_view line = content.substr(0, content.find('\n'));
    content.remove_prefix(std::min(line.size() + 1, content.size()));
    const auto refuse = [&](const char* what) {
      throw Error(ErrorCode::kBadFile, FileLocation{file.string(), number}, what);
    };
    line = line.substr(0, line.find('#'));
    std::size_t corners = 0;
    if (!continues) {
      const std::string_view key = take_word(line);
      is_element = key == "f" || key == "l" || key == "p";
    }
    bool goes_on = false;
    while (is_element && !goes_on) {
      const std::string_view word = take_word(line);
      if (word.empty()) break;
      goes_on = word == "\\";
      if (!goes_on && !is_corner(word)) refuse("has a corner that is no number.");
      ++corners;
    }
    if (is_element && corners == 0) refuse("has a face, line or point without corners.");
    continues = goes_on;
  }
}

}  // namespace tether::sim

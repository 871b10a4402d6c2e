#pragma once

#include <sstream>
#include <string>
#include <vector>

/// For properties that hold at every key of a TOML file.
namespace tether::scenario {

struct KeyLine {
  int line = 0;    // 1-based
  int header = 0;  // line of the table it is in; 0: the top of the file
  std::string key;
  std::string value;
  bool is_parameter = false;  // of a table whose keys are free
};

inline std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Every line "key = value".
inline std::vector<KeyLine> key_lines(const std::string& text) {
  std::vector<KeyLine> keys;
  int number = 0, header = 0;
  bool is_free = false;
  for (const std::string& line : lines_of(text)) {
    ++number;
    if (line.starts_with("[")) {
      header = number;
      is_free = line.ends_with("sut.parameters]") || line.ends_with("sut.files]");
    } else if (const auto equals = line.find(" = "); equals != std::string::npos) {
      keys.push_back({number, header, line.substr(0, equals), line.substr(equals + 3), is_free});
    }
  }
  return keys;
}

/// The text with another line in place of that one.
inline std::string with_line(const std::string& text, int number, const std::string& other) {
  std::string all;
  int at = 0;
  for (const std::string& line : lines_of(text)) all += (++at == number ? other : line) + "\n";
  return all;
}

}  // namespace tether::scenario

#include "gazebo_log.h"

#include <algorithm>
#include <regex>
#include <sstream>

namespace tether::app {

namespace {

/// Lines without colours and blanks at their ends; none that is empty.
std::vector<std::string> plain_lines(const std::string& log) {
  static const std::regex colour("\x1b\\[[0-9;]*m");
  std::vector<std::string> lines;
  std::istringstream text(log);
  for (std::string line; std::getline(text, line);) {
    line = std::regex_replace(line, colour, "");
    const auto begin = line.find_first_not_of(" \t\r"), end = line.find_last_not_of(" \t\r");
    if (begin != std::string::npos) lines.push_back(line.substr(begin, end - begin + 1));
  }
  return lines;
}

bool starts_with_any(const std::string& line, std::initializer_list<const char*> beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const char* beginning) { return line.starts_with(beginning); });
}

/// Each once, in their order.
void add(std::vector<std::string>& list, const std::string& text) {
  if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

}  // namespace

std::string last_words_of_gazebo(const std::string& log) {
  const auto lines = plain_lines(log);
  const auto last = std::find_if(lines.rbegin(), lines.rend(), [](const std::string& line) {
    return !starts_with_any(line, {"[Msg]", "[Wrn]", "[Dbg]", "ALSA lib", "AL lib", "Warning ["});
  });
  return last == lines.rend() ? "" : *last;
}

// A line that it still writes is left for later.
std::string plugin_error(const std::string& log) {
  static const std::regex error(
      "(Failed to (load plugin|resolve) .*|.*detected an incorrect plugin type.*)");
  for (const std::string& line : plain_lines(log.substr(0, log.rfind('\n') + 1))) {
    std::smatch match;
    if (std::regex_search(line, match, error)) return match[0];
  }
  return "";
}

std::string drawing_error(const std::string& log) {
  std::string gl;
  for (const std::string& line : plain_lines(log)) {
    if (line.starts_with("libGL error:")) gl = line + "; ";
    if (line.starts_with("X Error of failed request:")) return gl + line;
    if (line.find("Rendering will be disabled") != std::string::npos) return gl + line;
  }
  return "";
}

// libsdformat 9 writes "Error [Converter.cc:113] what" and "Error Code 12 Msg: what"; Gazebo itself
// writes "[Err] [Server.cc:392] what". It looks for a mesh with a relative path in its own folders
// only, says so in two lines, and goes on without.
std::vector<std::string> reading_errors(const std::string& log) {
  static const std::regex error(R"(Error (?:\[[^\]]*\]|Code \d+ Msg:)\s*(.*))");
  static const std::regex no_file(R"(.*does not exist \[[^\]]*\] \[(.*)\])");
  std::vector<std::string> errors;
  std::string file;
  for (const std::string& line : plain_lines(log)) {
    std::smatch match;
    if (std::regex_match(line, match, error)) add(errors, match[1]);
    if (std::regex_match(line, match, no_file)) file = match[1];
    if (line.ends_with("No mesh specified"))
      add(errors, "it does not find the mesh \"" + file +
                      "\", and would leave it out: name it by a model:// URI");
  }
  return errors;
}

}  // namespace tether::app

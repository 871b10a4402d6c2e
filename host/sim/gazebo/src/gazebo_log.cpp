#include "gazebo_log.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace tether::sim {

namespace {

// Lines may be as long as a world's names: std::regex, which needs stack for every character, is of
// no use here.

/// No person reads more.
std::string cut(const std::string& text) {
  constexpr std::size_t kLongest = 2000;
  return text.substr(0, kLongest);
}

std::string without_colours(const std::string& line) {
  constexpr std::string_view kBegin = "\x1b[";
  std::string plain;
  std::size_t done = 0;
  for (std::size_t at = line.find(kBegin); at != std::string::npos;
       at = line.find(kBegin, at + 1)) {
    const std::size_t end = line.find_first_not_of("0123456789;", at + kBegin.size());
    if (end == std::string::npos || line[end] != 'm') continue;
    plain.append(line, done, at - done);
    done = end + 1;
  }
  return plain.append(line, done);
}

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t\r"), end = text.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

/// Lines without colours and blanks at their ends; none that is empty.
std::vector<std::string> plain_lines(const std::string& log) {
  std::vector<std::string> lines;
  std::istringstream text(log);
  for (std::string line; std::getline(text, line);) {
    line = trimmed(without_colours(line));
    if (!line.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

bool starts_with_any(const std::string& line, std::initializer_list<const char*> beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const char* beginning) { return line.starts_with(beginning); });
}

bool holds(const std::string& line, const char* words) {
  return line.find(words) != std::string::npos;
}

/// Each once, in their order.
void add(std::vector<std::string>& list, const std::string& text) {
  if (std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

std::optional<std::string> after(const std::string& line, const char* words, std::size_t from = 0) {
  const std::size_t at = line.find(words, from);
  if (at == std::string::npos) return std::nullopt;
  return trimmed(line.substr(at + std::string_view(words).size()));
}

std::optional<std::string> error_of_libsdformat(const std::string& line) {
  if (line.starts_with("Error [")) return after(line, "]");
  if (line.starts_with("Error Code ")) return after(line, " Msg:");
  return std::nullopt;
}

/// Of "File or path does not exist [where] [file]".
std::optional<std::string> file_not_found(const std::string& line) {
  const std::size_t begin = line.rfind("does not exist [");
  if (begin == std::string::npos || line.back() != ']') return std::nullopt;
  auto file = after(line, "] [", begin);
  if (file) file->pop_back();
  return file;
}

}  // namespace

std::string last_words_of_gazebo(const std::string& log) {
  const auto lines = plain_lines(log);
  const auto last = std::find_if(lines.rbegin(), lines.rend(), [](const std::string& line) {
    return !starts_with_any(line, {"[Msg]", "[Wrn]", "[Dbg]", "ALSA lib", "AL lib", "Warning ["});
  });
  return last == lines.rend() ? "" : cut(*last);
}

// A line that it still writes is left for later.
std::string plugin_error(const std::string& log) {
  for (const std::string& line : plain_lines(log.substr(0, log.rfind('\n') + 1))) {
    if (holds(line, "detected an incorrect plugin type")) return cut(line);
    const auto failed =
        std::min(line.find("Failed to load plugin "), line.find("Failed to resolve "));
    if (failed != std::string::npos) return cut(line.substr(failed));
  }
  return "";
}

std::string drawing_error(const std::string& log) {
  std::string gl;
  for (const std::string& line : plain_lines(log)) {
    if (line.starts_with("libGL error:")) gl = cut(line) + "; ";
    if (line.starts_with("X Error of failed request:") || holds(line, "Rendering will be disabled"))
      return gl + cut(line);
  }
  return "";
}

// libsdformat 9 writes "Error [Converter.cc:113] what" and "Error Code 12 Msg: what"; Gazebo itself
// writes "[Err] [Server.cc:392] what". It looks for a mesh with a relative path in its own folders
// only, says so in two lines, and goes on without.
std::vector<std::string> reading_errors(const std::string& log) {
  std::vector<std::string> errors;
  std::string file;
  for (const std::string& line : plain_lines(log)) {
    if (const auto error = error_of_libsdformat(line)) add(errors, cut(*error));
    if (const auto missing = file_not_found(line)) file = cut(*missing);
    if (line.ends_with("No mesh specified"))
      add(errors, "it does not find the mesh \"" + file +
                      "\", and would leave it out: name it by a model:// URI");
  }
  return errors;
}

}  // namespace tether::sim

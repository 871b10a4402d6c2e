#include "gazebo_log.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace tether::sim {

namespace {

// Lines may be as long as a world's names, so there is no std::regex, which needs stack for every
// character.

/// Long lines are cut: reports quote them.
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

bool starts_with_any(const std::string& line, std::initializer_list<const char*> beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](const char* beginning) { return line.starts_with(beginning); });
}

bool holds(const std::string& line, const char* words) {
  return line.find(words) != std::string::npos;
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

/// Why a plugin is not loaded; empty: the line is about something else.
std::string plugin_error_of(const std::string& line) {
  if (holds(line, "detected an incorrect plugin type")) return cut(line);
  const auto failed =
      std::min(line.find("Failed to load plugin "), line.find("Failed to resolve "));
  return failed == std::string::npos ? "" : cut(line.substr(failed));
}

bool is_about_the_end(const std::string& line) {
  return !starts_with_any(line, {"[Msg]", "[Wrn]", "[Dbg]", "ALSA lib", "AL lib", "Warning ["});
}

bool is_drawing_error(const std::string& line) {
  return line.starts_with("X Error of failed request:") ||
         holds(line, "Rendering will be disabled");
}

/// Reads one line after the other.
class LogParser {
 public:
  void read(const std::string& line, bool is_complete) {
    read_sdf_errors(line);
    if (is_about_the_end(line)) read_last_line(line);
    if (line.starts_with("libGL error:")) gl_error_ = cut(line) + "; ";
    if (log_.drawing_error.empty() && is_drawing_error(line))
      log_.drawing_error = gl_error_ + cut(line);
    if (log_.plugin_error.empty() && is_complete) log_.plugin_error = plugin_error_of(line);
    log_.has_port_in_use = log_.has_port_in_use || holds(line, "Address already in use");
  }
  GazeboLog take() { return std::move(log_); }

 private:
  // libsdformat 9 writes "Error [Converter.cc:113] what" and "Error Code 12 Msg: what"; Gazebo
  // itself writes "[Err] [Server.cc:392] what". It searches for a mesh with a relative path in its
  // own folders only, reports that in two lines, and continues without the mesh.
  void read_sdf_errors(const std::string& line) {
    if (const auto error = error_of_libsdformat(line)) add_reading_error(cut(*error));
    if (const auto missing = file_not_found(line)) missing_file_ = cut(*missing);
    if (line.ends_with("No mesh specified"))
      add_reading_error("it does not find the mesh \"" + missing_file_ +
                        "\" and would leave it out; name it by a model:// URI");
  }

  // Each once.
  void add_reading_error(const std::string& error) {
    auto& errors = log_.reading_errors;
    if (std::find(errors.begin(), errors.end(), error) == errors.end()) errors.push_back(error);
  }

  void read_last_line(const std::string& line) {
    constexpr std::string_view kPlugin = "tether: ";
    using Writer = GazeboLog::Writer;
    log_.last_writer = line.starts_with(kPlugin)    ? Writer::kPlugin
                       : error_of_libsdformat(line) ? Writer::kSdfReader
                                                    : Writer::kGazebo;
    log_.last_line = cut(log_.last_writer == Writer::kPlugin ? line.substr(kPlugin.size()) : line);
  }

  GazeboLog log_;
  std::string gl_error_;
  std::string missing_file_;
};

}  // namespace

GazeboLog parse_gazebo_log(const std::string& text) {
  LogParser parser;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const bool is_complete = !lines.eof();
    line = trimmed(without_colours(line));
    if (!line.empty()) parser.read(line, is_complete);
  }
  return parser.take();
}

}  // namespace tether::sim

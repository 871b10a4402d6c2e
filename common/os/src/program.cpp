#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/program.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

bool is_program(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

bool is_source(const std::filesystem::path& file) {
  constexpr std::string_view kExtensions[] = {".cpp", ".cc", ".c",  ".h",
                                              ".hpp", ".rs", ".go", ".java"};
  return std::ranges::count(kExtensions, file.extension().string()) > 0;
}

/// The file with which a command line in one word begins: of "/bin/fly fast", "/bin/fly". Empty: it
/// is no command line.
std::string file_before_blank(const std::string& word) {
  std::error_code ignored;
  for (std::size_t blank = word.find(' '); blank != std::string::npos;
       blank = word.find(' ', blank + 1))
    if (std::filesystem::is_regular_file(word.substr(0, blank), ignored))
      return word.substr(0, blank);
  return "";
}

/// Why a path is not a program, and what to do.
std::string why_not(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return "it is a folder. Name a program in it";
  if (std::filesystem::exists(file, ignored))
    return is_source(file) ? "it is source code. Build it, and name the program"
                           : "it is not executable. Type: chmod +x " + file.string();
  if (std::ranges::find(file, std::filesystem::path("~")) != file.end())
    return "'~' does not stand for your home folder here. Write the whole path";
  if (const std::string program = file_before_blank(file); !program.empty())
    return "there is no such file. Write each argument apart: \"" + program + "\", \"" +
           file.string().substr(program.size() + 1) + "\"";
  return "there is no such file. Build it, or correct its path";
}

/// A script is a program only if its first line names one that exists.
void require_interpreter(const std::filesystem::path& script) {
  constexpr std::size_t kLongest = 256;  // of Linux
  const std::string begin = begin_of(script, kLongest);
  if (!begin.starts_with("#!")) return;
  std::string interpreter = begin.substr(2, begin.find('\n') - 2);
  interpreter.erase(0, interpreter.find_first_not_of(" \t"));
  interpreter = interpreter.substr(0, interpreter.find_first_of(" \t"));
  std::error_code ignored;
  if (interpreter.empty() || std::filesystem::exists(interpreter, ignored)) return;
  const bool is_of_windows = interpreter.ends_with('\r');
  throw Error(ErrorCode::kSetup, "cannot start \"" + script.string() +
                                     "\": its first line names the interpreter \"" + interpreter +
                                     "\", which does not exist. " +
                                     (is_of_windows ? "Save the file with the line ends of Unix"
                                                    : "Install it, or correct the line"))
      .about(script.string());
}

}  // namespace

std::filesystem::path own_file() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

namespace {

std::filesystem::path find_file(const std::string& name) {
  if (name.find('/') != std::string::npos) {
    if (is_program(name)) return name;
    throw Error(ErrorCode::kSetup, "cannot start \"" + name + "\": " + why_not(name)).about(name);
  }
  std::vector<std::filesystem::path> folders{own_file().parent_path()};
  const char* path = std::getenv("PATH");
  std::istringstream list(path ? path : "");
  for (std::string folder; std::getline(list, folder, ':');) folders.emplace_back(folder);
  for (const auto& folder : folders)
    if (is_program(folder / name)) return folder / name;
  throw Error(ErrorCode::kSetup, "cannot start \"" + name + "\": it is neither in " +
                                     own_file().parent_path().string() +
                                     " nor in PATH. Install it, or give its path, with a '/'")
      .about(name);
}

}  // namespace

std::filesystem::path find_program(const std::string& name) {
  std::filesystem::path file = find_file(name);
  require_interpreter(file);
  return file;
}

}  // namespace tether::os

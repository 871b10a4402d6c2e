#include <cstdlib>
#include <sstream>
#include <system_error>
#include <vector>

#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/program.h>

namespace tether::os {
namespace {

bool is_program(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

/// Why a path is not a program, and what to do.
std::string why_not(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return "it is a folder. Name a program in it";
  if (!std::filesystem::exists(file, ignored))
    return "there is no such file. Build it, or correct its path";
  return "it is not executable. Type: chmod +x " + file.string();
}

}  // namespace

std::filesystem::path own_file() {
  return std::filesystem::read_symlink("/proc/self/exe");
}

std::filesystem::path find_program(const std::string& name) {
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

}  // namespace tether::os

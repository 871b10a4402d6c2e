#include "as_is.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include <unistd.h>

namespace tether::exec {

std::string library_as_is() {
  std::error_code error;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error);
  // As installed, and as built.
  const std::filesystem::path library =
      own.parent_path().parent_path() / "lib" / "tether" / "tether-as-is.so";
  if (error || !std::filesystem::is_regular_file(library, error))
    throw std::runtime_error("the library " + library.string() +
                             " is missing. Install the package of tether-exec again");
  return library.string();
}

std::string become_as_is(const std::vector<std::string>& command) {
  std::string preloaded = library_as_is();
  if (const char* const others = std::getenv("LD_PRELOAD"); others != nullptr && *others != 0)
    preloaded += ":" + std::string(others);
  ::setenv("LD_PRELOAD", preloaded.c_str(), 1);
  ::setenv("TETHER_AS_IS", std::to_string(::getpid()).c_str(), 1);
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  ::execvp(words.front(), words.data());
  return command.front() + ": " + std::strerror(errno);
}

}  // namespace tether::exec

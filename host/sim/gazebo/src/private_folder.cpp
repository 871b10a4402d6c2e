#include "private_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>

namespace tether::sim {

namespace {

namespace fs = std::filesystem;

constexpr const char* kParent = "/tmp";

int open_folder(const fs::path& folder) {
  return open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

bool is_ours(int descriptor) {
  struct stat found {};
  return fstat(descriptor, &found) == 0 && found.st_uid == geteuid();
}

/// Whether the folder of that name is still the one that was opened.
bool is_still_there(const fs::path& folder, int descriptor) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && lstat(folder.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Removes it if it is ours and nobody alive holds it.
void remove_if_left(const fs::path& folder) {
  const int descriptor = open_folder(folder);
  if (descriptor < 0) return;
  std::error_code ignored;
  if (is_ours(descriptor) && flock(descriptor, LOCK_EX | LOCK_NB) == 0)
    fs::remove_all(folder, ignored);
  close(descriptor);
}

void remove_those_left(const std::string& prefix) {
  std::error_code error;
  for (fs::directory_iterator entry(kParent, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().filename().string().starts_with(prefix)) remove_if_left(entry->path());
}

[[noreturn]] void fail() {
  throw Error(ErrorCode::kSetup,
              fmt::format("{}: no folder can be made there: {}", kParent, std::strerror(errno)));
}

/// Makes a folder and locks it; −1 if another process took it for one that was left, and removed it
/// in between.
int make_and_lock(const std::string& prefix, fs::path& folder) {
  std::string name = fmt::format("{}/{}XXXXXX", kParent, prefix);
  if (!mkdtemp(name.data())) fail();
  folder = name;
  const int descriptor = open_folder(folder);
  if (descriptor < 0 && errno == ENOENT) return -1;
  if (descriptor < 0 || flock(descriptor, LOCK_EX) != 0) fail();
  if (is_still_there(folder, descriptor)) return descriptor;
  close(descriptor);
  return -1;
}

}  // namespace

PrivateFolder::PrivateFolder(const std::string& prefix) {
  remove_those_left(prefix);
  while (lock_ < 0) lock_ = make_and_lock(prefix, path_);
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  close(lock_);
}

}  // namespace tether::sim

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

os::FileDescriptor open_folder(const fs::path& folder) {
  return os::FileDescriptor(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

/// Removes it if it is this user's and no process holds it.
void remove_if_left(const fs::path& folder) {
  const os::FileDescriptor opened = open_folder(folder);
  struct stat found {};
  std::error_code ignored;
  if (fstat(opened.get(), &found) == 0 && found.st_uid == geteuid() &&
      flock(opened.get(), LOCK_EX | LOCK_NB) == 0)
    fs::remove_all(folder, ignored);
}

void remove_those_left(const std::string& prefix) {
  std::error_code error;
  for (fs::directory_iterator entry(kParent, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().filename().string().starts_with(prefix)) remove_if_left(entry->path());
}

[[noreturn]] void fail() {
  throw Error(ErrorCode::kSetup,
              fmt::format("{}: cannot make a folder: {}", kParent, std::strerror(errno)));
}

/// Whether the folder of that name is still the one that was opened.
bool is_still_there(const fs::path& folder, int descriptor) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && lstat(folder.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Makes a folder and locks it; none if another process removed it before it was locked.
os::FileDescriptor make_and_lock(const std::string& prefix, fs::path& folder) {
  std::string name = fmt::format("{}/{}XXXXXX", kParent, prefix);
  if (!mkdtemp(name.data())) fail();
  folder = name;
  os::FileDescriptor opened = open_folder(folder);
  if (!opened && errno == ENOENT) return {};
  if (!opened || flock(opened.get(), LOCK_EX) != 0) fail();
  if (!is_still_there(folder, opened.get())) return {};
  return opened;
}

}  // namespace

PrivateFolder::PrivateFolder(const std::string& prefix) {
  remove_those_left(prefix);
  while (!lock_) lock_ = make_and_lock(prefix, path_);
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace tether::sim

#include <cerrno>
#include <cstdlib>
#include <mutex>
#include <set>
#include <system_error>

#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

struct Living {
  std::mutex mutex;
  std::set<std::filesystem::path> folders;
};
/// Never destroyed: objects may outlive the statics of this file.
Living& living() {
  static auto& all = *new Living;
  return all;
}

/// Again if another thread made a file in it meanwhile.
void remove_quietly(const std::filesystem::path& folder) {
  std::error_code error;
  for (int attempt = 0; attempt < 10; ++attempt) {
    std::filesystem::remove_all(folder, error);
    if (!error) return;
  }
}

/// $TMPDIR, else /tmp. `temp_directory_path` fails if $TMPDIR is not a folder.
std::filesystem::path usual_parent() {
  const char* given = std::getenv("TMPDIR");
  return given != nullptr && *given != '\0' ? given : "/tmp";
}

}  // namespace

TemporaryFolder::TemporaryFolder(const std::string& prefix)
    : TemporaryFolder(prefix, usual_parent()) {}

TemporaryFolder::TemporaryFolder(const std::string& prefix, const std::filesystem::path& parent) {
  std::string name = (parent / (prefix + "XXXXXX")).string();
  // Held while it is made: a folder that exists is known.
  const std::lock_guard lock(living().mutex);
  if (::mkdtemp(name.data()) == nullptr) {
    const std::string reason = "cannot be made: " + reason_of(errno);
    throw Error(ErrorCode::kSetup, {name},
                parent == usual_parent()
                    ? reason + ". Make space there, or set TMPDIR to another folder"
                    : reason);
  }
  path_ = name;
  living().folders.insert(path_);
}

TemporaryFolder::~TemporaryFolder() {
  remove_quietly(path_);
  const std::lock_guard lock(living().mutex);
  living().folders.erase(path_);
}

void end_without_temporary_folders(int exit_code) {
  const std::lock_guard lock(living().mutex);  // until the end: nobody makes another one
  for (const std::filesystem::path& folder : living().folders) remove_quietly(folder);
  _exit(exit_code);
}

}  // namespace tether::os

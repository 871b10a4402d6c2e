#include "trial_folder.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/experiment/result.h>

namespace tether::app {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorCode::kSetup, path.string() + ": " + why + "; choose another folder with --out");
}

void make(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(folder, error.message());
}

/// The folder's descriptor, locked until it is closed.
int lock(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail(folder, std::strerror(errno));
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return descriptor;
  const int why = errno;
  close(descriptor);
  if (why != EWOULDBLOCK) fail(folder, std::strerror(why));
  throw Error(
      ErrorCode::kUsage,
      folder.string() + ": another run writes there; give this one a folder of its own with --out");
}

void drop(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) fail(file, error.message());
}

}  // namespace

TrialFolder::TrialFolder(const std::filesystem::path& folder) {
  make(folder);
  descriptor_ = lock(folder);
  // Rather now than when there is a result to write.
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail(folder, std::strerror(errno));
  drop(folder / experiment::kResultFile);
  drop(folder / kRecordFile);
  drop(folder / kSimulatorLog);
}

TrialFolder::~TrialFolder() {
  close(descriptor_);
}

}  // namespace tether::app

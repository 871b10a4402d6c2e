#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/result.h>
#include <tether/runner/trial_folder.h>

namespace tether::runner {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorCode::kSetup, {path.string()}, why + ". Choose another folder with --out.")
      .about(path.string());
}

void drop(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) fail(file, error.message());
}

constexpr off_t kRoomForResult_bytes = 32 * 1024;

/// Nothing if the file system cannot do it, or the limit of file sizes is lower.
os::FileDescriptor reserve_room(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / ".room";
  os::FileDescriptor room(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  ::unlink(file.c_str());
  const int error = room ? ::posix_fallocate(room.get(), 0, kRoomForResult_bytes) : 0;
  if (error == ENOSPC || error == EDQUOT) fail(folder, std::strerror(error));
  return room;
}

}  // namespace

TrialFolder::TrialFolder(const std::filesystem::path& folder)
    : claim_(folder, campaign::FolderClaim::By::kRun) {
  // Fail now, not when the result is written.
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail(folder, std::strerror(errno));
  drop(folder / campaign::kResultFile);
  drop(folder / kRecordFile);
  drop(folder / kSimulatorLog);
  room_ = reserve_room(folder);
}

}  // namespace tether::runner

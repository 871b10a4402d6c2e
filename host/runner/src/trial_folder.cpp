#include <cerrno>
#include <cstring>
#include <string>

#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/result.h>
#include <tether/runner/trial_folder.h>

namespace tether::runner {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
  throw Error(ErrorCode::kSetup, {path.string()}, why + "; choose another folder with --out")
      .about(path.string());
}

void make(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(folder, error.message());
}

/// Checks for a campaign again once the lock is held; a campaign that starts later sees the lock.
std::unique_ptr<campaign::PathLock> claim(const std::filesystem::path& folder) {
  campaign::require_no_campaign(folder);
  make(folder);
  auto lock = std::make_unique<campaign::PathLock>(folder);
  if (!lock->is_held())
    throw Error(ErrorCode::kUsage, {folder.string()},
                "another run writes to this folder; choose another one with --out")
        .about(folder.string());
  campaign::require_no_campaign(folder);
  return lock;
}

void drop(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) fail(file, error.message());
}

}  // namespace

TrialFolder::TrialFolder(const std::filesystem::path& folder) : lock_(claim(folder)) {
  // Fail now, not when the result is written.
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail(folder, std::strerror(errno));
  drop(folder / campaign::kResultFile);
  drop(folder / kRecordFile);
  drop(folder / kSimulatorLog);
}

}  // namespace tether::runner

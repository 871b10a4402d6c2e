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
  throw Error(ErrorCode::kSetup, {path.string()}, why + ". Choose another folder with --out.")
      .about(path.string());
}

void drop(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (error) fail(file, error.message());
}

}  // namespace

TrialFolder::TrialFolder(const std::filesystem::path& folder)
    : claim_(folder, campaign::FolderClaim::By::kRun) {
  // Fail now, not when the result is written.
  if (access(folder.c_str(), W_OK | X_OK) != 0) fail(folder, std::strerror(errno));
  drop(folder / campaign::kResultFile);
  drop(folder / kRecordFile);
  drop(folder / kSimulatorLog);
  drop(folder / kWarningsFile);
}

}  // namespace tether::runner

#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/text_file.h>
#include <tether/shards/shard.h>

// A copy under a name of its own, flushed, then one rename: it is atomic, and fails if the new name
// is a folder with content.
namespace tether::shards {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  throw Error(ErrorCode::kSetup, {path.string()}, what + ": " + reason_of(error) + ".")
      .about(path.string());
}

void require(const fs::path& path, const char* what, const std::error_code& failed) {
  if (failed) fail(path, what, failed.value());
}

/// Not by std::filesystem, which does not say that the disk is full.
void copy_content(const fs::path& from, const fs::path& to) {
  constexpr std::size_t kAtOnce = 1 << 30;
  const os::FileDescriptor source(::open(from.c_str(), O_RDONLY | O_CLOEXEC));
  if (!source) fail(from, "cannot be read", errno);
  const os::FileDescriptor own(::open(to.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!own) fail(to, "cannot be made", errno);
  for (ssize_t copied = 1; copied != 0;) {
    copied = ::sendfile(own.get(), source.get(), nullptr, kAtOnce);
    if (copied < 0) fail(to, "cannot be written", errno);
  }
  if (::fsync(own.get()) != 0) fail(to, "cannot be flushed", errno);
}

/// Files and folders; a pipe or a socket of a trial is of no use elsewhere.
void copy_all(const fs::path& from, const fs::path& to) {
  std::error_code failed;
  fs::create_directories(to, failed);
  require(to, "cannot be made", failed);
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path target = to / entry.path().filename();
    if (entry.is_directory()) copy_all(entry.path(), target);
    if (entry.is_regular_file()) copy_content(entry.path(), target);
  }
}

bool rename_to(const fs::path& from, const fs::path& to) {
  if (::rename(from.c_str(), to.c_str()) == 0) return true;
  if (errno == EEXIST || errno == ENOTEMPTY) return false;
  fail(to, "cannot be renamed", errno);
}

}  // namespace

bool hand_in(const fs::path& flown, const fs::path& campaign, const fs::path& trial) {
  const fs::path target = campaign / trial;
  if (campaign::has_result(target)) return false;
  const fs::path shards = campaign / campaign::kShardsFolder;
  std::error_code failed;
  fs::create_directories(shards, failed);
  require(shards, "cannot be made", failed);
  const os::TemporaryFolder staging("staging-", shards);
  copy_all(flown, staging / "new");
  fs::create_directories(target.parent_path(), failed);
  require(target.parent_path(), "cannot be made", failed);
  if (rename_to(staging / "new", target)) return true;
  if (campaign::has_result(target)) return false;
  // What was left of a flight that was cut, or a set-up that failed.
  (void)rename_to(target, staging / "old");
  return rename_to(staging / "new", target);
}

}  // namespace tether::shards

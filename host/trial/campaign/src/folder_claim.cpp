#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/folder_claim.h>
#include <tether/os/process_table.h>

// A run locks its folder. A campaign locks its folder too, and alone the lock file in it. A run or
// campaign in or below a campaign's folder shares that lock file, so that the campaign cannot start
// meanwhile; while it runs, only the trials that it started itself are let in.
namespace tether::campaign {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  require_a_handle_for(path.string());
  throw Error(ErrorCode::kSetup, {path.string()},
              fmt::format("{}: {}. Choose another folder with --out.", what, reason_of(error)))
      .about(path.string());
}

[[noreturn]] void refuse_busy(const fs::path& folder, const std::string& who) {
  refuse_folder(folder, who + ". Wait for it, or choose another folder with --out.");
}

/// The absolute path without symbolic links; what is at its end need not exist.
fs::path whole_path(const fs::path& folder) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(folder, failed);
  if (failed == std::errc::no_such_file_or_directory)
    throw Error(ErrorCode::kSetup, {folder.string()},
                "the working directory no longer exists. Change to another one, or give an "
                "absolute path with --out.")
        .about(folder.string());
  const fs::path whole = failed ? absolute : fs::weakly_canonical(absolute, failed);
  if (failed) fail(folder, "cannot be found", failed.value());
  return whole;
}

/// False: another process has held the lock for all of half a second. A killed one is gone by then.
bool lock(const os::FileDescriptor& file, int how, const fs::path& path) {
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (::flock(file.get(), how | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK) fail(path, "cannot be locked", errno);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

os::FileDescriptor open_own(const fs::path& path, int how) {
  os::FileDescriptor file(::open(path.c_str(), how | O_CLOEXEC, 0644));
  if (!file) fail(path, "cannot be opened", errno);
  return file;
}

/// 0: none is written.
pid_t process_in(const os::FileDescriptor& file) {
  std::array<char, 16> text{};
  const ssize_t size = ::pread(file.get(), text.data(), text.size(), 0);
  pid_t process = 0;
  if (size > 0) std::from_chars(text.data(), text.data() + size, process);
  return process;
}

void write_process(const os::FileDescriptor& file, const fs::path& path) {
  const std::string text = std::to_string(::getpid());
  const auto size = static_cast<ssize_t>(text.size());
  if (::ftruncate(file.get(), 0) != 0 || ::pwrite(file.get(), text.data(), text.size(), 0) != size)
    fail(path, "cannot be written", errno);
}

/// It started us, or the server that did (runner/trial_server.h).
bool has_started_us(pid_t process) {
  if (process == ::getppid()) return true;
  const auto server = os::process_stat(::getppid());
  return server && process == server->parent;
}

bool has_trial(const fs::path& campaign, const fs::path& folder) try {
  if (!fs::exists(campaign / kCampaignFile)) return false;
  const CampaignManifest manifest = read_manifest(campaign);
  const fs::path relative = folder.lexically_relative(campaign);
  for (const CampaignManifest::Entry& entry : manifest.scenarios)
    for (const std::string& condition : entry.conditions)
      for (const std::uint64_t seed : manifest.seeds)
        if (relative == trial_folder(entry.scenario, condition, seed)) return true;
  return false;
} catch (const std::exception&) {
  return false;  // no campaign that could be reported on
}

/// Shares the lock of the campaign in `root`, if there is one. None: the campaign started us.
void share_campaign(const fs::path& root, const fs::path& whole, const fs::path& folder,
                    std::vector<os::FileDescriptor>& locks) {
  const fs::path path = root / kLockFile;
  os::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  const bool is_absent = errno == ENOENT || errno == ENOTDIR || errno == EACCES || errno == EPERM;
  if (!file && !is_absent) fail(path, "cannot be opened", errno);
  if (file) {
    const bool is_held = ::flock(file.get(), LOCK_SH | LOCK_NB) != 0;
    const pid_t process = process_in(file);
    if (is_held && has_started_us(process)) return;
    if (!lock(file, LOCK_SH, path))
      refuse_busy(folder, fmt::format("a campaign is running in {}{}",
                                      root == whole ? "this folder" : root.string(),
                                      process > 0 ? fmt::format(" (process {})", process) : ""));
    locks.push_back(std::move(file));
  }
  if (has_trial(root, whole))
    refuse_folder(folder,
                  fmt::format("is a trial of the campaign in {}, whose results must be of one "
                              "kind. Choose another folder with --out, or remove this one and "
                              "run the campaign with --resume.",
                              root.string()));
}

/// Of the campaigns in `innermost` and in every folder above it.
std::vector<os::FileDescriptor> share_campaigns(const fs::path& innermost, const fs::path& whole,
                                                const fs::path& folder) {
  std::vector<os::FileDescriptor> locks;
  for (fs::path root = innermost;; root = root.parent_path()) {
    share_campaign(root, whole, folder, locks);
    if (root == root.parent_path()) return locks;
  }
}

}  // namespace

void require_place(const fs::path& folder) {
  const fs::path whole = whole_path(folder);
  fs::path existing = whole;
  std::error_code none;
  while (!fs::exists(existing, none) && existing.has_relative_path())
    existing = existing.parent_path();
  const std::string what =
      existing == whole ? std::string() : "cannot be made, because " + existing.string() + " ";
  if (!fs::is_directory(existing, none))
    refuse_folder(folder, what + "is a file, not a folder. Choose another name with --out.");
  if (::access(existing.c_str(), W_OK | X_OK) != 0)
    refuse_folder(folder,
                  what + "is not writable. Choose another folder with --out, or change its mode.");
}

FolderClaim::FolderClaim(const fs::path& folder, By by) {
  const fs::path whole = whole_path(folder);
  (void)share_campaigns(whole, whole, folder);  // makes nothing where it is refused
  require_place(folder);
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed == std::errc::no_space_on_device || failed == std::errc::io_error)
    fail(folder, "cannot be made", failed.value());
  if (failed)
    refuse_folder(folder, fmt::format("cannot be made: {}. Choose another folder with --out.",
                                      failed.message()));
  const auto lock_campaign = [&](int how, const char* who) {
    const fs::path path = folder / kLockFile;
    os::FileDescriptor file = open_own(path, O_RDWR | O_CREAT);
    if (!lock(file, how, path)) refuse_busy(folder, who);
    if (how == LOCK_EX) write_process(file, path);
    locks_.push_back(std::move(file));
  };
  if (by == By::kShard) {
    locks_ = share_campaigns(whole.parent_path(), whole, folder);
    lock_campaign(LOCK_SH, "a campaign is running in this folder");
    return;
  }
  os::FileDescriptor own = open_own(folder, O_RDONLY);
  if (!lock(own, LOCK_EX, folder)) refuse_busy(folder, "another run writes there");
  // Of two processes that come at once, one finds the other's lock now.
  locks_ = share_campaigns(by == By::kRun ? whole : whole.parent_path(), whole, folder);
  locks_.push_back(std::move(own));
  if (by == By::kRun) return;
  lock_campaign(LOCK_EX, "another run writes in a folder below");
}

}  // namespace tether::campaign

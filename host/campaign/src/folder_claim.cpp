#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
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

namespace tether::campaign {
namespace {

namespace fs = std::filesystem;

/// A killed process is gone by then, however much memory it had.
constexpr auto kPatience = std::chrono::seconds(2);
/// Whoever only looks is gone by then, however little of the processor he gets.
constexpr auto kLookersStay = std::chrono::milliseconds(200);

[[noreturn]] void fail(const fs::path& path, const char* what) {
  const std::string why = std::strerror(errno);
  require_a_handle_for(path.string());
  throw Error(ErrorCode::kSetup,
              fmt::format("{}: cannot be {}: {}; choose another folder with --out", path.string(),
                          what, why));
}

/// What is to be known of a lock without taking it.
struct Holder {
  bool is_there = false;
  pid_t process = 0;  ///< as it wrote; 0: it wrote nothing
};

pid_t written_process(int descriptor) {
  char text[16] = {};
  const ssize_t size = ::pread(descriptor, text, sizeof text, 0);
  pid_t process = 0;
  if (size > 0) std::from_chars(text, text + size, process);
  return std::max(process, 0);
}

/// A lock that is shared for a moment disturbs nobody who looks as well; PathLock waits. Where
/// there is nothing, and where nobody may look, nobody of ours is.
Holder holder_of(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    if (errno == ENOENT || errno == ENOTDIR || errno == EACCES || errno == EPERM) return {};
    fail(path, "opened");
  }
  Holder holder;
  if (::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    holder = {true, written_process(descriptor)};
  ::close(descriptor);
  return holder;
}

/// Written before it looks for others itself: of two who come at once, one sees the other.
Holder campaign_in(const fs::path& folder) {
  const Holder holder = holder_of(folder / kLockFile);
  return holder.process > 0 ? holder : Holder{};
}

bool is_trial_of(const CampaignManifest& campaign, const fs::path& folder) {
  for (const CampaignManifest::Entry& entry : campaign.scenarios)
    for (const std::string& condition : entry.conditions)
      for (const std::uint64_t seed : campaign.seeds)
        if (folder == trial_folder(entry.scenario, condition, seed)) return true;
  return false;
}

bool has_trial(const fs::path& campaign, const fs::path& folder) try {
  return fs::exists(campaign / kCampaignFile) &&
         is_trial_of(read_manifest(campaign), folder.lexically_relative(campaign));
} catch (const std::exception&) {
  return false;  // no campaign that could be reported on
}

[[noreturn]] void refuse_claim(const fs::path& folder, const std::string& why) {
  throw Error(ErrorCode::kUsage, folder.string() + ": " + why);
}

[[noreturn]] void refuse_busy(const fs::path& folder, const std::string& what) {
  refuse_claim(folder, what + "; wait for it, or choose another folder with --out");
}

[[noreturn]] void refuse_running(const fs::path& folder, const fs::path& campaign,
                                 const fs::path& whole) {
  const std::string where =
      campaign == whole ? "this folder" : campaign.string() + ", to which this folder belongs";
  refuse_busy(folder, "a campaign is running in " + where);
}

void require_not_in(const fs::path& campaign, const fs::path& folder, const fs::path& whole) {
  const Holder holder = campaign_in(campaign);
  if (holder.is_there && (holder.process == ::getppid() || holder.process == ::getpid())) return;
  if (holder.is_there) refuse_running(folder, campaign, whole);
  if (has_trial(campaign, whole))
    refuse_claim(folder,
                 fmt::format("is a trial of the campaign in {}, whose results must be of one "
                             "kind; choose another folder with --out, or remove this one and "
                             "run the campaign with --resume",
                             campaign.string()));
}

/// Whether that is still so after this time, and has been all along.
template <class Question>
bool stays(const Question& is_so, std::chrono::milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (is_so()) {
    if (std::chrono::steady_clock::now() >= deadline) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

/// Whoever is just being killed is waited for.
void require_free(const fs::path& place, const fs::path& folder) {
  const bool is_own = place == folder;
  if (!is_own && stays([&] { return campaign_in(place).is_there; }, kPatience))
    refuse_busy(folder, "a campaign is running in " + place.string());
  if (stays([&] { return holder_of(place).is_there; }, kPatience))
    refuse_busy(folder, "another run writes in " + place.string());
}

/// From the root on, without links.
fs::path whole_path(const fs::path& folder) {
  std::error_code failed;
  const fs::path absolute = fs::absolute(folder, failed);
  if (failed == std::errc::no_such_file_or_directory)
    throw Error(ErrorCode::kSetup, folder.string() +
                                       ": the working directory is not there any more; change to "
                                       "one that is, or give a whole path with --out");
  const fs::path whole = failed ? absolute : fs::weakly_canonical(absolute, failed);
  if (!failed) return whole;
  errno = failed.value();
  fail(folder, "found");
}

}  // namespace

PathLock::PathLock(const fs::path& path, bool makes_file)
    : path_(path),
      descriptor_(
          ::open(path.c_str(), O_CLOEXEC | (makes_file ? O_RDWR | O_CREAT : O_RDONLY), 0644)) {
  if (descriptor_ < 0) fail(path, "opened");
  const auto is_busy = [this] {
    is_held_ = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    return !is_held_ && errno == EWOULDBLOCK;
  };
  if (stays(is_busy, kLookersStay) || is_held_) return;
  const int why = errno;
  ::close(descriptor_);
  errno = why;
  fail(path, "locked");
}

PathLock::~PathLock() {
  ::close(descriptor_);
}

void PathLock::write(std::string_view text) const {
  const auto size = static_cast<ssize_t>(text.size());
  if (::pwrite(descriptor_, text.data(), text.size(), 0) != size ||
      ::ftruncate(descriptor_, size) != 0)
    fail(path_, "written");
}

void require_no_campaign(const fs::path& folder) {
  const fs::path whole = whole_path(folder);
  for (fs::path above = whole; !above.empty(); above = above.parent_path()) {
    require_not_in(above, folder, whole);
    if (above == above.root_path()) return;
  }
}

void require_nobody_in(const fs::path& folder) {
  require_free(folder, folder);
  std::error_code failed;
  constexpr auto kHow = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator entry(folder, kHow, failed), end; entry != end && !failed;
       entry.increment(failed))
    if (entry->is_directory() && !entry->is_symlink()) require_free(entry->path(), folder);
  if (!failed) return;
  errno = failed.value();
  fail(folder, "read");
}

}  // namespace tether::campaign

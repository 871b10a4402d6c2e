#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/folder_claim.h>
#include <tether/campaign/result.h>
#include <tether/campaign/run_campaign.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial_folder.h>

// An earlier run is recognised by its files, and replaced as a whole or not at all. Its files are
// those that Tether writes (by name; of JUnit files, by content), and those that its SUTs wrote
// (listed in its result).
namespace tether::runner {

namespace {

namespace fs = std::filesystem;

/// The files that Tether writes to a trial's folder, as patterns of paths in it.
struct OwnFile {
  std::string_view pattern;
  bool shows_a_run = false;  ///< as opposed to what is made of a record later
};
constexpr OwnFile kOwnFiles[] = {
    {campaign::kResultFile, true},
    {kRecordFile, true},
    {kMarginsFile},
    {kSimulatorLog, true},
    {kWarningsFile, true},
    {"sut-*.log", true},
    {"exec-*.log", true},
    {campaign::kReportFile},
    {"plots/*.svg"},
    {"frames/*.svg"},
    {campaign::kTrialLog},
    {campaign::kSecondTrialLog},
};

bool matches(const OwnFile& own, const std::string& path) {
  return fnmatch(std::string(own.pattern).c_str(), path.c_str(), FNM_PATHNAME) == 0;
}

bool is_own(std::string path) {
  if (path.ends_with(os::kPartSuffix)) path.resize(path.size() - os::kPartSuffix.size());
  return std::ranges::any_of(kOwnFiles, [&](const OwnFile& own) { return matches(own, path); });
}

[[noreturn]] void fail(const fs::path& path, const std::string& why) {
  throw Error(ErrorCode::kSetup, {path.string()}, why + ". Choose another folder with --out.")
      .about(path.string());
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(fs::symlink_status(path, ignored));
}

/// Everything below a folder that can be read, each folder before its content. Links are not
/// followed.
std::vector<fs::path> all_below(const fs::path& folder) {
  std::error_code ended;
  std::vector<fs::path> all;
  constexpr auto kHow = fs::directory_options::skip_permission_denied;
  for (auto entry = fs::recursive_directory_iterator(folder, kHow, ended);
       !ended && entry != fs::recursive_directory_iterator(); entry.increment(ended))
    all.push_back(entry->path());
  return all;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> entries;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) entries.push_back(entry.path());
  return entries;
}

bool shows_a_run(const fs::path& entry) {
  return std::ranges::any_of(kOwnFiles, [name = entry.filename().string()](const OwnFile& own) {
    return own.shows_a_run && matches(own, name);
  });
}

/// The result of the earlier run; none if it was killed, or the file is damaged.
std::optional<campaign::TrialResult> result_in(const fs::path& folder) try {
  return campaign::read_result(folder);
} catch (const Error&) {
  return std::nullopt;
}

std::string describe(const std::optional<campaign::TrialResult>& run) {
  if (!run) return "a run without a usable result";
  return fmt::format("the run of \"{}\" under \"{}\", seed {}", run->scenario, run->condition,
                     run->seed);
}

/// "'a', 'b' and 3 more".
std::string first_of(std::vector<std::string> names) {
  constexpr std::size_t kMostNames = 3;
  const std::size_t more = names.size() - std::min(names.size(), kMostNames);
  names.resize(names.size() - more);
  return fmt::format("'{}'{}", fmt::join(names, "', '"),
                     more > 0 ? fmt::format(" and {} more", more) : "");
}

/// Made for an earlier run, and not changed into the user's own.
bool is_made_scenario(const fs::path& file) {
  return file.filename() == kMadeScenarioFile &&
         os::begin_of(file, kMadeScenario.size()) == kMadeScenario;
}

void remove_earlier_run(const fs::path& folder, const campaign::TrialResult* run,
                        const fs::path& kept) {
  std::vector<fs::path> all = all_below(folder);
  std::error_code ignored;
  std::erase_if(all, [&](const fs::path& file) { return fs::equivalent(file, kept, ignored); });
  std::vector<std::string> of_others;
  for (const fs::path& file : all) {
    const std::string path = file.lexically_relative(folder).string();
    const bool is_of_sut = run && std::ranges::count(run->this_run.sut_files, path) > 0;
    if (!is_folder(file) && !is_own(path) && !is_of_sut && !campaign::is_junit(file) &&
        !is_made_scenario(file))
      of_others.push_back(path);
  }
  std::ranges::sort(of_others);
  if (!of_others.empty())
    campaign::refuse_folder(
        folder, fmt::format("the earlier run there cannot be replaced, because the folder also "
                            "has {}, which Tether and the SUTs of that run did not write. Move "
                            "them, or choose another folder with --out.",
                            first_of(std::move(of_others))));
  std::ranges::reverse(all);  // what is in a folder before the folder
  std::error_code failed;
  for (const fs::path& path : all)
    if (!fs::remove(path, failed) && failed) fail(path, failed.message());
}

/// Refuses what is left of an earlier run whose record was removed: it would seem to be of this
/// run.
void refuse_remains(const fs::path& folder) {
  for (const char* name : {campaign::kReportFile.data(), "plots", "frames"})
    if (fs::exists(folder / name))
      campaign::refuse_folder(
          folder, fmt::format("has '{}' of something else. Remove it, or choose another folder "
                              "with --out.",
                              name));
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

TrialFolder::TrialFolder(const fs::path& folder, EarlierRun earlier, const fs::path& kept)
    : folder_(folder), claim_(folder, campaign::FolderClaim::By::kRun) {
  // Fail now, not when the result is written.
  if (access(folder.c_str(), R_OK | W_OK | X_OK) != 0) fail(folder, std::strerror(errno));
  if (fs::exists(folder / campaign::kCampaignFile))
    campaign::refuse_folder(folder, "has a campaign. Choose another folder with --out.");
  if (std::ranges::any_of(entries_of(folder), shows_a_run)) {
    const auto run = result_in(folder);
    if (earlier == EarlierRun::kRefuse)
      campaign::refuse_folder(
          folder, fmt::format("has {}. Choose another folder with --out, or replace that run "
                              "with --force.",
                              describe(run)));
    remove_earlier_run(folder, run ? &*run : nullptr, kept);
  }
  refuse_remains(folder);
  room_ = reserve_room(folder);
  for (const fs::path& entry : entries_of(folder)) of_others_.insert(entry.filename());
}

std::vector<std::string> TrialFolder::files_of_suts() const {
  std::vector<std::string> paths;
  for (const fs::path& entry : entries_of(folder_)) {
    if (of_others_.contains(entry.filename())) continue;
    for (const fs::path& file : is_folder(entry) ? all_below(entry) : std::vector{entry}) {
      const std::string path = file.lexically_relative(folder_).string();
      if (!is_folder(file) && !is_own(path)) paths.push_back(path);
    }
  }
  std::ranges::sort(paths);
  return paths;
}

}  // namespace tether::runner

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/text.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/folder_claim.h>
#include <tether/os/text_file.h>

namespace tether::campaign {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kNewPrefix = ".new-";

// A campaign.json that was being written when a campaign ended is replaced by the next one, and a
// JUnit file is written before its campaign begins.
bool holds_anything(const fs::path& folder) {
  const std::string partial = std::string(kCampaignFile) + std::string(os::kPartSuffix);
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const fs::path name = entry.path().filename();
    const bool is_ours = name == kLockFile || name == partial || name == kShardsFolder ||
                         name.string().starts_with(kNewPrefix) || is_junit(entry.path());
    if (!is_ours) return true;
  }
  if (!failed) return false;
  throw Error(ErrorCode::kSetup, {folder.string()}, "cannot be read: " + failed.message() + ".")
      .about(folder.string());
}

/// Otherwise the trial is flown again.
bool counts(const TrialResult& result) {
  return result.end != kEndSetupFailed && result.end != kEndInterrupted;
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none))
    names.insert(entry.path().filename().string());
  return names;
}

void require_same(const fs::path& folder, const Settings& then, const Settings& now,
                  OpenMode mode) {
  // Of a file, the value is its digest, which tells people nothing.
  const auto refuse_setting = [&](const std::string& name, const std::string& of_file,
                                  const std::string& of_other) {
    const std::string difference =
        name.starts_with(kFileSetting)
            ? fmt::format("the file {} {}", name.substr(kFileSetting.size()), of_file)
            : fmt::format("'{}' {}", name, of_other);
    throw Error(ErrorCode::kUsage, {folder.string()},
                fmt::format("contains trials with other settings: {}. Results of both must "
                            "not be mixed, so choose another folder{}.",
                            difference, mode == OpenMode::kResume ? " and omit --resume" : ""))
        .about(name);
  };
  for (const auto& [name, value] : now) {
    const auto before = then.find(name);
    if (before == then.end()) refuse_setting(name, "was not used then", "is new");
    if (before->second != value)
      refuse_setting(name, "has changed", fmt::format("was {} and is {}", before->second, value));
  }
  for (const auto& [name, value] : then)
    if (!now.contains(name)) refuse_setting(name, "is not used now", "no longer exists");
}

// Everything that the campaign plans, as a person would name it.
std::vector<std::string> planned(const CampaignManifest& campaign) {
  std::vector<std::string> names;
  for (const auto& entry : campaign.scenarios) {
    names.push_back(fmt::format("scenario '{}'", entry.scenario));
    for (const std::string& condition : entry.conditions)
      names.push_back(fmt::format("condition '{}' of '{}'", condition, entry.scenario));
  }
  for (const std::uint64_t seed : campaign.seeds) names.push_back(fmt::format("seed {}", seed));
  return names;
}

// The results of what is no longer planned would be in no table. Names the first few.
void require_nothing_dropped(const fs::path& folder, const CampaignManifest& then,
                             const CampaignManifest& now) {
  constexpr std::size_t kMostNames = 4;
  const std::vector<std::string> kept = planned(now);
  std::vector<std::string> dropped = planned(then);
  std::erase_if(dropped, [&](const std::string& name) {
    return std::find(kept.begin(), kept.end(), name) != kept.end();
  });
  if (dropped.empty()) return;
  if (now.name.starts_with(kSizePrefix))
    refuse_folder(
        folder,
        "has the flights of another search, with another --between, --condition or "
        "--axis. Choose another folder with --out, or remove those flights with --force.");
  const std::size_t more = dropped.size() - std::min(dropped.size(), kMostNames);
  dropped.resize(dropped.size() - more);
  refuse_folder(
      folder,
      fmt::format("was begun for {}{}, which this campaign no longer has. Put that "
                  "back, or choose another folder.",
                  fmt::join(dropped, ", "), more > 0 ? fmt::format(" and {} more", more) : ""));
}

/// Of the campaign of that name.
CampaignManifest manifest_in(const fs::path& folder, const std::string& name) {
  std::error_code ignored;
  if (!fs::exists(folder / kCampaignFile, ignored))
    refuse_folder(folder, "is not empty and contains no campaign. Choose another folder.");
  CampaignManifest then = read_manifest(folder);
  if (then.name != name)
    refuse_folder(folder,
                  fmt::format("contains the campaign '{}', not '{}'. Choose another folder.",
                              then.name, name));
  return then;
}

// Of how many, is not known for tether size: it plans more than it flies.
[[noreturn]] void refuse_results(const fs::path& folder, std::size_t finished) {
  refuse_folder(folder, fmt::format("already contains {}. Continue with --resume, or choose "
                                    "another folder.",
                                    counted(finished, "result")));
}

// Otherwise a mistyped name would fly everything again. What was killed early left its lock.
fs::path with_something_to_resume(fs::path folder, OpenMode mode) {
  if (mode != OpenMode::kResume) return folder;
  std::error_code none;
  const fs::file_status status = fs::status(folder, none);
  if (status.type() == fs::file_type::not_found)
    refuse_folder(folder,
                  "does not exist, so --resume has nothing to continue. Give the right folder to "
                  "--out, or omit --resume to begin.");
  if (fs::is_directory(status) && fs::is_empty(folder, none))
    refuse_folder(folder,
                  "is empty, so --resume has nothing to continue. Give the right folder to --out, "
                  "or omit --resume to begin.");
  return folder;
}

}  // namespace

void require_folder(const fs::path& folder, const scenario::Campaign& campaign, OpenMode mode) {
  require_place(folder);
  (void)with_something_to_resume(folder, mode);
  std::error_code none;
  if (!fs::exists(folder, none) || !holds_anything(folder)) return;
  (void)manifest_in(folder, campaign.name);
  if (mode != OpenMode::kFresh) return;
  const std::vector<TrialPlan> plans = plan_trials(campaign, folder);
  const auto finished =
      std::ranges::count_if(plans, [](const TrialPlan& plan) { return has_result(plan.folder); });
  if (finished > 0) refuse_results(folder, static_cast<std::size_t>(finished));
}

CampaignFolder::CampaignFolder(fs::path folder, const scenario::Campaign& campaign,
                               const Settings& settings, OpenMode mode)
    : folder_(with_something_to_resume(std::move(folder), mode)),
      claim_(folder_,
             mode == OpenMode::kShard ? FolderClaim::By::kShard : FolderClaim::By::kCampaign) {
  const CampaignManifest manifest = manifest_of(campaign, settings);
  if (holds_anything(folder_)) {
    check_existing(manifest, mode);
    if (mode == OpenMode::kReplace) remove_existing();
  }
  sort_trials(campaign);
  if (mode == OpenMode::kFresh && !finished_.empty()) refuse_results(folder_, finished_.size());
  write_manifest(manifest, mode);
  // A report of fewer trials would lie beside the new ones.
  std::error_code ignored;
  if (!missing_.empty()) fs::remove(folder_ / kReportFile, ignored);
}

// Several shards may come at once, and write the same.
void CampaignFolder::write_manifest(const CampaignManifest& manifest, OpenMode mode) const {
  const std::string text = to_json(manifest);
  if (mode != OpenMode::kShard) return os::write_file_atomically(folder_ / kCampaignFile, text);
  const os::TemporaryFolder own(std::string(kNewPrefix), folder_);
  os::write_file_atomically(own / "campaign", text);
  std::error_code failed;
  fs::rename(own / "campaign", folder_ / kCampaignFile, failed);
  if (failed)
    throw Error(ErrorCode::kSetup, {(folder_ / kCampaignFile).string()},
                "cannot be written: " + failed.message() + ".")
        .about(folder_.string());
}

void CampaignFolder::check_existing(const CampaignManifest& now, OpenMode mode) const {
  const CampaignManifest then = manifest_in(folder_, now.name);
  if (mode == OpenMode::kReplace) return;
  require_nothing_dropped(folder_, then, now);
  require_same(folder_, then.settings, now.settings, mode);
}

void CampaignFolder::remove_existing() const {
  std::error_code failed;
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder_, failed))
    if (entry.path().filename() != kLockFile) paths.push_back(entry.path());
  for (const fs::path& path : paths)
    if (!failed) fs::remove_all(path, failed);
  if (!failed) return;
  throw Error(ErrorCode::kSetup, {folder_.string()}, "cannot be emptied: " + failed.message() + ".")
      .about(folder_.string());
}

// One listing for each condition: most of the trials that tether size plans never fly.
void CampaignFolder::sort_trials(const scenario::Campaign& campaign) {
  std::map<std::string, std::set<std::string>> trials_in;  // by the folder of the condition
  for (TrialPlan& plan : plan_trials(campaign, folder_)) {
    const fs::path condition = plan.folder.parent_path();
    const auto [listed, is_new] = trials_in.try_emplace(condition.string());
    if (is_new) listed->second = names_in(condition);
    const bool is_finished =
        listed->second.contains(plan.folder.filename().string()) && has_usable_result(plan);
    (is_finished ? finished_ : missing_).push_back(std::move(plan));
  }
}

bool is_junit(const fs::path& file) {
  return os::begin_of(file, kJunitBegin.size()) == kJunitBegin;
}

std::optional<TrialResult> result_in(const fs::path& trial) try {
  std::error_code ignored;
  if (!fs::exists(trial / kResultFile, ignored)) return std::nullopt;
  TrialResult result = read_result(trial);
  return counts(result) ? std::optional(std::move(result)) : std::nullopt;
} catch (const Error&) {
  return std::nullopt;
}

bool CampaignFolder::has_usable_result(const TrialPlan& plan) {
  std::error_code ignored;
  if (!fs::exists(plan.folder / kResultFile, ignored)) return false;
  try {
    const TrialResult result = read_result(plan.folder);
    const bool is_this_trial = result.scenario == plan.scenario->name &&
                               result.condition == plan.condition->name && result.seed == plan.seed;
    if (!is_this_trial)
      warnings_.push_back(plan.folder.string() + ": is the result of another trial");
    return is_this_trial && counts(result);
  } catch (const Error& error) {
    warnings_.emplace_back(error.what());
    return false;
  }
}

}  // namespace tether::campaign

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <tether/campaign/campaign_folder.h>
#include <tether/os/text_file.h>

namespace tether::campaign {
namespace {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (!failed) return;
  throw Error(ErrorCode::kSetup, FileLocation{folder.string()},
              "the folder cannot be made: " + failed.message());
}

// A campaign.json that was being written when all ended goes with the next one.
bool holds_anything(const fs::path& folder) {
  const std::string torn = std::string(kCampaignFile) + std::string(os::kPartSuffix);
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const fs::path name = entry.path().filename();
    if (name != kLockFile && name != torn) return true;
  }
  if (!failed) return false;
  throw Error(ErrorCode::kSetup, FileLocation{folder.string()},
              "the folder cannot be read: " + failed.message());
}

// The first setting that is not the same; empty: none.
std::string difference(const Settings& then, const Settings& now) {
  for (const auto& [name, value] : now) {
    const auto before = then.find(name);
    if (before == then.end()) return fmt::format("'{}' is new", name);
    if (before->second == value) continue;
    return fmt::format("'{}' was {} and is {}", name, before->second, value);
  }
  for (const auto& [name, value] : then) {
    if (!now.contains(name)) return fmt::format("'{}' is no longer there", name);
  }
  return "";
}

bool has_scenario(const CampaignManifest& manifest, const std::string& name) {
  return std::any_of(manifest.scenarios.begin(), manifest.scenarios.end(),
                     [&](const auto& entry) { return entry.scenario == name; });
}

bool has_condition(const CampaignManifest& manifest, const std::string& scenario,
                   const std::string& condition) {
  return std::any_of(manifest.scenarios.begin(), manifest.scenarios.end(), [&](const auto& entry) {
    return entry.scenario == scenario && std::find(entry.conditions.begin(), entry.conditions.end(),
                                                   condition) != entry.conditions.end();
  });
}

// What was planned then and is no longer: its results would be in no table.
std::vector<std::string> left_out(const CampaignManifest& then, const CampaignManifest& now) {
  std::vector<std::string> missing;
  for (const auto& entry : then.scenarios) {
    if (!has_scenario(now, entry.scenario)) {
      missing.push_back(fmt::format("scenario '{}'", entry.scenario));
      continue;
    }
    for (const std::string& condition : entry.conditions) {
      if (has_condition(now, entry.scenario, condition)) continue;
      missing.push_back(fmt::format("condition '{}' of '{}'", condition, entry.scenario));
    }
  }
  for (const std::uint64_t seed : then.seeds) {
    if (std::find(now.seeds.begin(), now.seeds.end(), seed) != now.seeds.end()) continue;
    missing.push_back(fmt::format("seed {}", seed));
  }
  return missing;
}

// The first few by name.
std::string listed(std::vector<std::string> names) {
  constexpr std::size_t kMost = 4;
  if (names.size() > kMost) {
    const std::size_t more = names.size() - kMost;
    names.resize(kMost);
    names.push_back(fmt::format("{} more", more));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& why) {
  throw Error(ErrorCode::kUsage, FileLocation{folder.string()}, why);
}

}  // namespace

CampaignFolder::CampaignFolder(fs::path folder, const scenario::Campaign& campaign,
                               const Settings& settings, OpenMode mode)
    : folder_(std::move(folder)) {
  const CampaignManifest manifest = manifest_of(campaign, settings);
  require_no_campaign(folder_);
  make_folder(folder_);
  require_nobody_in(folder_);
  lock_ = std::make_unique<PathLock>(folder_ / kLockFile, true);
  if (!lock_->is_held())
    refuse(folder_, "a campaign is running in this folder; wait for it, or choose another");
  lock_->write(std::to_string(::getpid()));
  // Whoever came meanwhile sees the lock, or is seen now.
  require_no_campaign(folder_);
  require_nobody_in(folder_);
  if (holds_anything(folder_)) check_existing(manifest, mode);
  find_missing(campaign);
  if (mode == OpenMode::kFresh && finished_ > 0) {
    refuse(folder_, fmt::format("already holds {} of {} trials; go on with --resume, or choose "
                                "another folder",
                                finished_, finished_ + missing_.size()));
  }
  os::write_file_atomically(folder_ / kCampaignFile, to_json(manifest));
}

CampaignFolder::~CampaignFolder() = default;

void CampaignFolder::check_existing(const CampaignManifest& now, OpenMode mode) const {
  std::error_code ignored;
  if (!fs::exists(folder_ / kCampaignFile, ignored)) {
    refuse(folder_, "is not empty and holds no campaign; choose another folder");
  }
  const CampaignManifest then = read_manifest(folder_);
  if (then.name != now.name) {
    refuse(folder_, fmt::format("holds the campaign '{}', not '{}'; choose another folder",
                                then.name, now.name));
  }
  const std::vector<std::string> missing = left_out(then, now);
  if (!missing.empty()) {
    refuse(folder_, fmt::format("holds a campaign with {}, which this one leaves out, and with it "
                                "finished trials; choose another folder, or put it back",
                                listed(missing)));
  }
  const std::string changed = difference(then.settings, now.settings);
  if (changed.empty()) return;
  refuse(folder_, fmt::format("holds trials of other settings: {}; results of both must not be "
                              "mixed, so choose another folder{}",
                              changed, mode == OpenMode::kResume ? " and leave out --resume" : ""));
}

void CampaignFolder::find_missing(const scenario::Campaign& campaign) {
  for (TrialPlan& plan : plan_trials(campaign, folder_)) {
    if (has_usable_result(plan)) {
      ++finished_;
    } else {
      missing_.push_back(std::move(plan));
    }
  }
}

bool CampaignFolder::has_usable_result(const TrialPlan& plan) {
  std::error_code ignored;
  if (!fs::exists(plan.folder / kResultFile, ignored)) return false;
  try {
    const TrialResult result = read_result(plan.folder);
    const bool is_this_trial = result.scenario == plan.scenario->name &&
                               result.condition == plan.condition->name && result.seed == plan.seed;
    if (!is_this_trial) warnings_.push_back(plan.folder.string() + ": is of another trial");
    return is_this_trial && result.end != kEndSetupFailed && result.end != kEndInterrupted;
  } catch (const Error& error) {
    warnings_.emplace_back(error.what());
    return false;
  }
}

}  // namespace tether::campaign

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/campaign_plan.h>
#include <tether/os/text_file.h>
#include <tether/shards/shard.h>

namespace tether::shards {
namespace {

namespace fs = std::filesystem;
using campaign::CampaignManifest;

CampaignManifest manifest_in(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / campaign::kCampaignFile, ignored)) return campaign::read_manifest(folder);
  throw Error(ErrorCode::kUsage, {folder.string()},
              "has no campaign. Give folders that `tether campaign CAMPAIGN --shard K/N --out "
              "FOLDER` made.")
      .about(folder.string());
}

/// Why results of both must not be mixed; empty: they may.
std::string difference(const CampaignManifest& one, const CampaignManifest& other) {
  if (one.name != other.name) return fmt::format("is of the campaign '{}'", other.name);
  for (const auto& [name, value] : one.settings) {
    const auto found = other.settings.find(name);
    if (found == other.settings.end()) return fmt::format("lacks '{}'", name);
    if (found->second != value)
      return fmt::format("'{}' is {}, not {}", name, found->second, value);
  }
  for (const auto& [name, value] : other.settings)
    if (!one.settings.contains(name)) return fmt::format("has '{}' as well", name);
  if (one != other) return "has other scenarios, conditions or seeds";
  return "";
}

std::vector<fs::path> trials_of(const CampaignManifest& manifest) {
  std::vector<fs::path> trials;
  for (const CampaignManifest::Entry& entry : manifest.scenarios)
    for (const std::uint64_t seed : manifest.seeds)
      for (const std::string& condition : entry.conditions)
        trials.push_back(campaign::trial_folder(entry.scenario, condition, seed));
  return trials;
}

bool is_same_flight(const fs::path& one, const fs::path& other) {
  campaign::TrialResult a = campaign::read_result(one), b = campaign::read_result(other);
  a.this_run = b.this_run = {};
  return a == b;
}

}  // namespace

Collected collect(const std::vector<fs::path>& folders) {
  const fs::path& into = folders.front();
  std::error_code ignored;
  const bool is_new = !fs::exists(into / campaign::kCampaignFile, ignored);
  if (is_new && folders.size() > 1) {
    const CampaignManifest first = manifest_in(folders[1]);
    fs::create_directories(into, ignored);
    os::write_file_atomically(into / campaign::kCampaignFile, to_json(first));
  }
  const CampaignManifest manifest = manifest_in(into);
  const std::vector<fs::path> trials = trials_of(manifest);
  Collected collected{.planned = trials.size()};
  for (auto folder = folders.begin() + 1; folder != folders.end(); ++folder) {
    const std::string why = difference(manifest, manifest_in(*folder));
    if (!why.empty()) {
      collected.left_out.push_back(fmt::format("{}: {}", folder->string(), why));
      continue;
    }
    for (const fs::path& trial : trials) {
      if (!campaign::has_result(*folder / trial)) continue;
      if (hand_in(*folder / trial, into, trial))
        ++collected.brought;
      else if (!is_same_flight(into / trial, *folder / trial))
        collected.differing.push_back(fmt::format("{}: {} has another result, which is not used",
                                                  trial.string(), folder->string()));
    }
  }
  for (const fs::path& trial : trials)
    if (!campaign::has_result(into / trial)) collected.missing.push_back(trial);
  return collected;
}

}  // namespace tether::shards

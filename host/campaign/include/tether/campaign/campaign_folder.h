#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/folder_claim.h>
#include <tether/campaign/result.h>

/// A campaign's folder on the disk: `campaign.json` says what was planned and under which
/// settings; each finished trial has a folder of its own with `result.json` and its record.
namespace tether::campaign {

inline constexpr int kCampaignSchemaVersion = 1;
inline constexpr std::string_view kCampaignFile = "campaign.json";

/// `campaign.json`.
struct CampaignManifest {
  struct Entry {
    std::string scenario;
    std::string description;
    std::string paper_table;  ///< "I" to "V"; empty: none
    std::vector<std::string> conditions;
    std::vector<std::string> metrics;  ///< names

    friend bool operator==(const Entry&, const Entry&) = default;
  };
  std::string name;
  std::string description;
  std::vector<std::uint64_t> seeds;
  std::vector<Entry> scenarios;
  Settings settings;

  friend bool operator==(const CampaignManifest&, const CampaignManifest&) = default;
};
CampaignManifest manifest_of(const scenario::Campaign& campaign, Settings settings);
std::string to_json(const CampaignManifest& manifest);
/// @throws Error(kBadFile) when the folder has no usable campaign.json.
CampaignManifest read_manifest(const std::filesystem::path& folder);

enum class OpenMode {
  kFresh,   ///< the folder must hold no results yet
  kResume,  ///< go on with what is there
};

/// A campaign's folder, held by this process alone while the object lives. Not thread-safe.
class CampaignFolder {
 public:
  /// Makes the folder or opens it again, and finds out which trials are missing: those without a
  /// result, with a torn or damaged one, and those that failed to be set up or were interrupted.
  /// @throws Error(kUsage), changing nothing, when the folder holds something else, results of
  ///   other settings or versions (named), a campaign with more seeds, conditions or scenarios
  ///   (named: their trials would drop out of every mean), results although `mode` is kFresh, or
  ///   somebody else writes in it; Error(kSetup) when the file system refuses.
  /// @pre `campaign` outlives the object.
  CampaignFolder(std::filesystem::path folder, const scenario::Campaign& campaign,
                 const Settings& settings, OpenMode mode);
  ~CampaignFolder();
  CampaignFolder(const CampaignFolder&) = delete;
  CampaignFolder& operator=(const CampaignFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  /// In the order of `plan_trials`.
  const std::vector<TrialPlan>& missing() const { return missing_; }
  std::size_t finished() const { return finished_; }
  /// One line for each result that was there and cannot be used.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void check_existing(const CampaignManifest& now, OpenMode mode) const;
  void find_missing(const scenario::Campaign& campaign);
  bool has_usable_result(const TrialPlan& plan);

  std::filesystem::path folder_;
  std::unique_ptr<PathLock> lock_;
  std::vector<TrialPlan> missing_;
  std::size_t finished_ = 0;
  std::vector<std::string> warnings_;
};

}  // namespace tether::campaign

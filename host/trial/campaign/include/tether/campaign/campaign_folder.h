#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tether/campaign/campaign_plan.h>
#include <tether/campaign/folder_claim.h>
#include <tether/campaign/result.h>

/// A campaign's folder on the disk: `campaign.json` contains the plan and the settings; the folder
/// of each finished trial contains `result.json` and its record.
namespace tether::campaign {

inline constexpr int kCampaignSchemaVersion = 1;
inline constexpr std::string_view kCampaignFile = "campaign.json";
/// The campaign in the folder of `tether size` is called this and the scenario's name. Names of
/// campaign files have no spaces.
inline constexpr std::string_view kSizePrefix = "size of ";

using Setting = scenario::Setting;

/// `campaign.json`.
struct CampaignManifest {
  struct Entry {
    std::string scenario;
    std::string description;
    std::string paper_table;  ///< "I" to "V"; empty: none
    std::vector<std::string> conditions;
    std::vector<std::string> metrics;  ///< names
    /// Of a point of a sweep: the scenario without its settings, and these. Empty: none.
    std::string swept_from{};
    std::vector<Setting> settings{};

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
/// @throws Error(kBadFile) if the folder has no usable campaign.json.
CampaignManifest read_manifest(const std::filesystem::path& folder);

/// What processes and machines that fly parts of the campaign leave beside its trials.
inline constexpr std::string_view kShardsFolder = ".shards";

/// The result in the folder of a trial, if it counts: not that of a failed set-up, or of a flight
/// that was interrupted. None, too, if it is damaged.
std::optional<TrialResult> result_in(const std::filesystem::path& trial);
inline bool has_result(const std::filesystem::path& trial) {
  return result_in(trial).has_value();
}

enum class OpenMode {
  kFresh,    ///< the folder must not contain results yet
  kResume,   ///< continue with the results that exist; the folder must not be missing or empty
  kShard,    ///< continue as kResume, beside other shards; the folder may be missing
  kReplace,  ///< remove the results of a campaign of that name, and everything beside them
};

/// Checks what of the folder can be known before any file of a trial is read. Makes and changes
/// nothing. @throws Error(kUsage), about the folder, as CampaignFolder.
void require_folder(const std::filesystem::path& folder, const scenario::Campaign& campaign,
                    OpenMode mode);

/// A campaign's folder, claimed by this process while the object lives. Not thread-safe.
class CampaignFolder {
 public:
  /// Makes the folder or opens it again, and determines which trials are missing: those without a
  /// result, with a truncated or corrupt one, and those whose set-up failed or that were
  /// interrupted. Removes the report of the folder if any are.
  /// @throws Error(kUsage), about the folder and without a change, if the folder contains something
  ///   else, results with other settings or versions (about the setting), a campaign with more
  ///   seeds, conditions or scenarios (whose trials would be missing from every mean), results
  ///   although `mode` is kFresh, or nothing although it is kResume; as FolderClaim if another
  ///   process writes in it. Error(kSetup) if the file system refuses.
  /// @pre `campaign` outlives the object.
  CampaignFolder(std::filesystem::path folder, const scenario::Campaign& campaign,
                 const Settings& settings, OpenMode mode);

  const std::filesystem::path& path() const { return folder_; }
  /// In the order of `plan_trials`.
  const std::vector<TrialPlan>& missing() const { return missing_; }
  /// The others, in the same order.
  const std::vector<TrialPlan>& finished() const { return finished_; }
  /// One line for each existing result that cannot be used; begins with its file or folder.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void check_existing(const CampaignManifest& now, OpenMode mode) const;
  void write_manifest(const CampaignManifest& manifest, OpenMode mode) const;
  void remove_existing() const;
  void sort_trials(const scenario::Campaign& campaign);
  bool has_usable_result(const TrialPlan& plan);

  std::filesystem::path folder_;
  FolderClaim claim_;
  std::vector<TrialPlan> missing_, finished_;
  std::vector<std::string> warnings_;
};

}  // namespace tether::campaign

#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

/// Parts of a campaign that other processes fly, on this machine or on others (ADR 0072).
namespace tether::shards {

/// Part K of N of a list of trials: the trials of every N-th seed, from the K-th on. All conditions
/// of a seed are on one machine, so that no machine looks like a condition.
struct Shard {
  std::size_t number = 1;  ///< 1 to `of`
  std::size_t of = 1;

  /// @param seed its number, as of `seed_numbers`.
  bool takes(std::size_t seed) const { return seed % of == number - 1; }
  friend bool operator==(const Shard&, const Shard&) = default;
};
/// Of "K/N". @throws Error(kUsage) about --shard for other texts.
Shard parse_shard(const std::string& text);

/// Trials for shards, as a file in the campaign's folder.
struct TrialList {
  struct Trial {
    std::filesystem::path folder;  ///< of its result, relative to the campaign's folder
    std::string request;           ///< as text

    friend bool operator==(const Trial&, const Trial&) = default;
  };
  std::map<std::string, std::string> files{};  ///< on which results depend: digest by path
  /// The results depend on the machine: all shards must run on equal ones.
  bool measures = false;
  std::vector<Trial> trials{};

  friend bool operator==(const TrialList&, const TrialList&) = default;
};
/// Of each trial, the number of its seed in its scenario, counted through all scenarios, from 0.
std::vector<std::size_t> seed_numbers(const std::vector<TrialList::Trial>& trials);
std::string to_json(const TrialList& list);
/// The inverse. @throws Error(kBadFile) at `file` for other texts.
TrialList parse_trial_list(std::string_view text, const std::filesystem::path& file);

/// The digest of each file, by its path. @throws Error(kBadFile) if one cannot be read.
std::map<std::string, std::string> digests_of(const std::vector<std::filesystem::path>& files);
/// Checks that this machine has the files as they were.
/// @throws Error(kBadFile) about the first file that is missing or has another digest.
void require_same_files(const std::map<std::string, std::string>& digests);
/// Checks that all shards below the campaign's folder run on machines with this description: the
/// first one leaves it there. @throws Error(kBadFile), about the machine, on another one.
void require_same_machine(const std::filesystem::path& campaign, const std::string& machine);

struct Collected {
  std::size_t brought = 0;               ///< results that are new in the first folder
  std::vector<std::string> differing{};  ///< results of one trial that differ; one line each
  std::vector<std::string> left_out{};   ///< folders that are not of this campaign; one line each
  std::vector<std::filesystem::path> missing{};  ///< trials without a result, relative
  std::size_t planned = 0;
};

/// Brings the results of all folders of a campaign together in the first one, which is made if it
/// does not exist. The others stay as they are. A folder with another campaign, other trials, files
/// or versions is left out. Of several results of one trial, the first one counts; the others are
/// listed if they differ in more than what each run has of its own (times of the host, names).
/// @pre folders is not empty.
/// @throws Error(kUsage) about a folder that has no campaign; Error(kSetup) as hand_in.
Collected collect(const std::vector<std::filesystem::path>& folders);

/// Copies the folder of a flown trial into the campaign's folder, where it appears as a whole. What
/// is there stays if it has a result that counts; a failed set-up is replaced. Several processes on
/// any machines may do this at once (the folder may be shared, for instance over NFS): one wins.
/// @param flown anywhere. @param trial relative to `campaign`.
/// @returns whether it is there now; false if another result was.
/// @throws Error(kSetup) with the path if the file system refuses; nothing is left of the copy.
bool hand_in(const std::filesystem::path& flown, const std::filesystem::path& campaign,
             const std::filesystem::path& trial);

}  // namespace tether::shards

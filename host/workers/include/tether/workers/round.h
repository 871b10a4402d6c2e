#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tether/workers/shared_folder.h>

/// The files of the protocol between a collector, which plans trials, and workers, which fly them.
/// A round is a folder that appears as a whole and does not change afterwards, but for the files
/// that workers add:
///
///     .tether-workers/rounds/0001/round.json         the settings
///                                 items/00000        the trials of a shard, one line of JSON each
///                                 claims/00000/05    whose chunk 5 of that shard is
///                                 full/00000         all chunks of the shard are claimed
///                                 workers/ID         a worker that has started, and how it fares
///                                 lost/17            why the machine, not the UAV, failed item 17
///                     nodes/NAME                     how fast a node is
///                     staging/ID/17                  a trial's folder while it is being copied
///
/// A trial's folder gets its name in the campaign's folder by a rename, with its whole content.
namespace tether::workers {

inline constexpr const char* kWorkersFolder = ".tether-workers";
/// A trial that was lost that often is not tried again.
inline constexpr std::size_t kMostLosses = 3;
/// Chunks of trials that share a file of items and a folder of claims.
inline constexpr std::size_t kChunksPerShard = 64;

/// One trial to fly.
struct Item {
  std::string folder;                 ///< of its result, relative to the campaign's folder
  std::string request;                ///< the trial, as text
  std::vector<std::string> losses{};  ///< why earlier attempts were lost, one line each

  friend bool operator==(const Item&, const Item&) = default;
};

/// What all trials of a round have in common.
struct RoundSettings {
  std::string job{};            ///< unique name of the job that starts the workers
  std::size_t items = 0;        ///< set by create_round
  std::size_t chunk = 1;        ///< trials that a worker claims at once
  bool beats = false;           ///< workers must show that they are alive: no engine knows it
  bool measures_nodes = false;  ///< the trials' clock depends on the speed of the machine
  bool scales_nodes = false;    ///< and CPU time is scaled by it, instead of refusing unlike nodes
  std::map<std::string, std::string> files{};    ///< that every node must have: digest by path
  std::map<std::string, std::string> command{};  ///< the collector's, to go on collecting

  friend bool operator==(const RoundSettings&, const RoundSettings&) = default;
};

/// Which part of the items a worker claims at once.
struct Chunk {
  std::size_t shard = 0;
  std::size_t index = 0;  ///< in the shard

  friend auto operator<=>(const Chunk&, const Chunk&) = default;
};

/// A whole round in a campaign's folder. Thread-safe; functions throw as SharedFolder, and
/// Error(kBadFile) for files that are not as a collector writes them.
class Round {
 public:
  /// @pre the round exists.
  Round(const SharedFolder& folder, std::size_t number);

  const SharedFolder& folder() const { return *folder_; }
  std::size_t number() const { return number_; }
  const RoundSettings& settings() const { return settings_; }
  std::filesystem::path path(const std::string& name) const { return path_ / name; }
  /// On this machine.
  std::filesystem::path whole_path(const std::string& name) const;

  std::size_t shards() const;
  std::size_t chunks(std::size_t shard) const;
  std::size_t first_item(const Chunk& chunk) const;
  std::size_t end_item(const Chunk& chunk) const;  ///< one behind the last
  std::vector<Item> items(std::size_t shard) const;
  std::vector<std::size_t> claimed_chunks(std::size_t shard) const;
  std::filesystem::path claim_file(const Chunk& chunk) const;

 private:
  const SharedFolder* folder_;
  std::size_t number_;
  std::filesystem::path path_;
  RoundSettings settings_;
};

/// The newest round; none: no collector has made one.
std::optional<Round> newest_round(const SharedFolder& folder);

/// Makes the round of that number; none if there is one meanwhile, made by another collector.
/// @pre items is not empty.
std::optional<Round> create_round(const SharedFolder& folder, std::size_t number,
                                  RoundSettings settings, const std::vector<Item>& items);

/// A name that no other call returns, on any machine.
std::string unique_name();

}  // namespace tether::workers

#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/workers/round.h>

/// `tether worker`: claims trials of a round, flies them on this machine, and hands the results in.
namespace tether::workers {

/// A worker that lost so many trials in a row ends: its machine is broken.
inline constexpr std::size_t kMostLossesInARow = 2;
/// How far the speeds of two nodes can differ and still count as equal.
inline constexpr double kLikeNodes = 1.15;

/// Who a worker is.
struct WorkerName {
  std::string id;    ///< unique; a file name
  std::string node;  ///< the machine
  std::string task;  ///< of the engine that started it; empty: none
};

/// How a flight ended.
struct Flight {
  enum class End {
    kResult,   ///< its folder is whole, whatever the outcome of the trial
    kLost,     ///< the machine failed: there is no result
    kStopped,  ///< this worker was asked to end
  };
  End end = End::kResult;
  std::string why{};  ///< of a flight without a result: one line
};

struct WorkerSetup {
  WorkerName self;
  std::filesystem::path scratch;  ///< an empty folder of this machine, not shared
  /// Flies the item, with CPU time counted so many times, and leaves everything in the folder,
  /// which exists and is empty.
  std::function<Flight(const Item&, const std::filesystem::path&, double cpu_time_scale)> fly;
  /// Called after each flight, before its result counts: throws if it must not.
  std::function<void()> check = [] {};
  /// CPU time of a fixed piece of work on this machine [ms]; called once for each node.
  std::function<double()> measure_ms{};
  std::stop_token stop{};
};

struct WorkerEnd {
  std::size_t flown = 0;  ///< results that are in the campaign's folder
  std::size_t lost = 0;
  std::string why_early{};  ///< it ended before nothing was left; empty: it did not
};

/// Flies trials of the round until all are claimed, the machine fails twice in a row, or a stop is
/// requested. Uses only what SharedFolder relies on.
/// @throws Error(kUsage) about the node if its speed is not that of the others; what `check`
///   throws; as SharedFolder if a result cannot be handed in. The trial in hand is then lost.
WorkerEnd work(const Round& round, const WorkerSetup& setup);

/// Hands out the chunks of a round, each to one caller on any machine. With many workers, the calls
/// of one worker list each shard a few times, and look for others only when it has been used up.
class Claims {
 public:
  Claims(const Round& round, const WorkerName& self);

  /// None: all chunks are claimed.
  std::optional<Chunk> next();

 private:
  bool enter_shard();
  void list_free();

  const Round& round_;
  std::string text_;
  std::uint64_t key_;
  std::optional<std::size_t> shard_;
  std::vector<std::size_t>
      free_;  // chunks of the shard when it was listed, those to try first last
};

/// How a worker fares, from its file.
struct WorkerState {
  WorkerName name;
  std::uint64_t beat = 0;
  bool has_ended = false;
  std::string why_early{};
  bool is_refused = false;  ///< because of the speed of its node
};
/// By the id of the worker. Files that cannot be read, for instance because they are just being
/// written, are omitted.
std::map<std::string, WorkerState> read_workers(const Round& round);

/// A claim or a loss, as its file says; fields are empty if it was not written completely.
struct Note {
  std::string worker;
  std::string node;
  std::string task;
  std::string why{};
};
Note read_note(const SharedFolder& folder, const std::filesystem::path& file);

/// What CPU time of this node has to be multiplied by, so that it counts like that of the first
/// node that was measured. Measures this node unless that was done.
/// @throws Error(kUsage) about the node if it must not be scaled and its speed differs.
double node_scale(const Round& round, const WorkerSetup& setup);

}  // namespace tether::workers

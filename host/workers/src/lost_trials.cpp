#include "lost_trials.h"

#include <algorithm>

#include <fmt/format.h>

#include <tether/workers/worker.h>

namespace tether::workers {
namespace {

/// Why a worker that claimed a chunk has vanished, in the engine's words.
std::string end_of(const Note& claim, const std::vector<Task>& tasks) {
  for (const Task& task : tasks)
    if (!task.name.empty() && (task.name == claim.task || task.name == claim.worker))
      return "the worker vanished: " + task.state;
  return "the worker vanished";
}

}  // namespace

void LostTrials::add_losses_of(const Round& round, const std::set<std::string>& results,
                               const std::vector<Task>& tasks, bool is_cancelled) {
  nodes_.clear();
  const auto workers = read_workers(round);
  for (const auto& [id, worker] : workers) {
    if (!worker.is_refused) continue;
    nodes_.insert(worker.name.node);
    news_.push_back(worker.why_early);
  }
  const auto& folder = round.folder();
  const std::vector<std::string> marks = folder.list(round.path("lost"));
  for (std::size_t shard = 0; shard < round.shards(); ++shard) {
    const std::vector<Item> items = round.items(shard);
    const std::vector<std::size_t> claimed = round.claimed_chunks(shard);
    for (std::size_t c = 0; c < round.chunks(shard); ++c) {
      const Chunk chunk{shard, c};
      bool was_seen = false;  // the trial that was in flight when the worker vanished
      for (std::size_t i = round.first_item(chunk); i < round.end_item(chunk); ++i) {
        const Item& item = items.at(i - round.first_item({shard, 0}));
        if (results.contains(item.folder)) continue;
        losses_[item.folder] = item.losses;
        if (is_cancelled) continue;
        const std::string number = std::to_string(i);
        if (std::ranges::binary_search(marks, number)) {
          const Note mark = read_note(folder, round.path("lost/" + number));
          lose(item, mark.node, mark.why);
        } else if (!was_seen && std::ranges::binary_search(claimed, c)) {
          was_seen = true;
          const Note claim = read_note(folder, round.claim_file(chunk));
          const auto worker = workers.find(claim.worker);
          const bool has_ended = worker != workers.end() && worker->second.has_ended;
          if (!has_ended) lose(item, claim.node, end_of(claim, tasks));
        }
      }
    }
  }
}

std::vector<std::string> LostTrials::losses(const std::string& folder) const {
  const auto found = losses_.find(folder);
  return found == losses_.end() ? std::vector<std::string>{} : found->second;
}

void LostTrials::lose(const Item& item, const std::string& node, const std::string& why) {
  if (!node.empty()) nodes_.insert(node);
  const std::string loss = fmt::format("{}: {}", node.empty() ? "unknown node" : node,
                                       why.empty() ? "no reason was written" : why);
  losses_[item.folder].push_back(loss);
  news_.push_back(fmt::format("lost: {}, on {}", name_of_(item.folder), loss));
}

}  // namespace tether::workers

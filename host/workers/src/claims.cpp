#include "notes.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include <tether/base/random.h>
#include <tether/workers/worker.h>

// A worker enters a shard at random, lists its claims once, and tries the free chunks in an order
// of its own, so that workers rarely try the same. It leaves a shard that has no free chunk with a
// mark, so that others need not list it.
namespace tether::workers {

Claims::Claims(const Round& round, const WorkerName& self)
    : round_(round), text_(text_of(self)), key_(random_stream(self.id, "", "claims")) {}

std::optional<Chunk> Claims::next() {
  constexpr int kTriesOfOneListing = 4;
  for (int tries = 0;; ++tries) {
    if (free_.empty() || tries == kTriesOfOneListing) {
      tries = 0;
      if (shard_) list_free();
      while (free_.empty()) {
        if (!enter_shard()) return std::nullopt;
        list_free();
      }
    }
    const Chunk chunk{*shard_, free_.back()};
    free_.pop_back();
    if (round_.folder().create(round_.claim_file(chunk), text_)) return chunk;
  }
}

// False: every shard is used up.
bool Claims::enter_shard() {
  std::vector<bool> is_full(round_.shards());
  for (const std::string& name : round_.folder().list(round_.path("full"))) {
    std::size_t shard = 0;
    const auto read = std::from_chars(name.data(), name.data() + name.size(), shard);
    if (read.ec == std::errc() && shard < is_full.size()) is_full[shard] = true;
  }
  std::vector<std::size_t> open;
  for (std::size_t shard = 0; shard < is_full.size(); ++shard)
    if (!is_full[shard]) open.push_back(shard);
  if (open.empty()) return false;
  KeyedRandom random({.seed = key_, .stream = 0, .index = open.size()});
  shard_ = open[random.bits() % open.size()];
  return true;
}

void Claims::list_free() {
  const std::vector<std::size_t> claimed = round_.claimed_chunks(*shard_);
  free_.clear();
  for (std::size_t chunk = 0; chunk < round_.chunks(*shard_); ++chunk)
    if (!std::ranges::binary_search(claimed, chunk)) free_.push_back(chunk);
  if (free_.empty()) {
    round_.folder().create(round_.path(fmt::format("full/{:05}", *shard_)), "");
    shard_.reset();
    return;
  }
  KeyedRandom random({.seed = key_, .stream = 1 + *shard_, .index = free_.size()});
  for (std::size_t left = free_.size(); left > 1; --left)
    std::swap(free_[left - 1], free_[random.bits() % left]);
}

}  // namespace tether::workers

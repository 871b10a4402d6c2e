#include "sensors/capture_store.h"

#include <algorithm>
#include <utility>

namespace tether::coordinator {

SharedState StatePool::at(SimTime st, const std::function<void(sim::Snapshot&)>& capture) {
  if (latest_ && latest_at_ == st) return latest_;
  latest_.reset();
  const auto& state = take_unused();
  capture(*state);
  latest_at_ = st;
  return latest_ = state;
}

// States are mostly given up in the order in which they were taken.
std::shared_ptr<sim::Snapshot>& StatePool::take_unused() {
  for (std::size_t tried = 0; tried < states_.size(); ++tried) {
    last_taken_ = (last_taken_ + 1) % states_.size();
    if (states_[last_taken_].use_count() == 1) return states_[last_taken_];
  }
  return states_.emplace_back(std::make_shared<sim::Snapshot>());
}

void CaptureStore::add(std::uint64_t index, SharedState state) {
  entries_.push_back({index, std::move(state)});
}

const sim::Snapshot* CaptureStore::find(std::uint64_t index) const {
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& e) { return e.index == index; });
  return entry == entries_.end() ? nullptr : entry->state.get();
}

void CaptureStore::drop_before(std::uint64_t index) {
  const auto keep = std::find_if(entries_.begin(), entries_.end(),
                                 [&](const Entry& e) { return e.index >= index; });
  entries_.erase(entries_.begin(), keep);
}

}  // namespace tether::coordinator

#include "capture_store.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tether::coordinator {

sim::Snapshot& CaptureStore::add(std::uint64_t index) {
  Entry entry;
  if (!spare_.empty()) {
    entry = std::move(spare_.back());
    spare_.pop_back();
  }
  entry.index = index;
  return entries_.emplace_back(std::move(entry)).snapshot;
}

const sim::Snapshot* CaptureStore::find(std::uint64_t index) const {
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& e) { return e.index == index; });
  return entry == entries_.end() ? nullptr : &entry->snapshot;
}

void CaptureStore::drop_before(std::uint64_t index) {
  const auto keep = std::find_if(entries_.begin(), entries_.end(),
                                 [&](const Entry& e) { return e.index >= index; });
  spare_.insert(spare_.end(), std::make_move_iterator(entries_.begin()),
                std::make_move_iterator(keep));
  entries_.erase(entries_.begin(), keep);
}

}  // namespace tether::coordinator

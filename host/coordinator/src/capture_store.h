#pragma once

#include <cstdint>
#include <vector>

#include <tether/sim/simulator.h>

namespace tether::coordinator {

/// The captured states of one periodic sensor that may still be read: a few, in the order of their
/// indices. Storage is reused, so that steady use allocates nothing.
class CaptureStore {
 public:
  /// The place for the state of measurement `index`. @pre greater than every earlier index.
  sim::Snapshot& add(std::uint64_t index);
  /// nullptr if that state was not captured, or was dropped.
  const sim::Snapshot* find(std::uint64_t index) const;
  /// Drops the states of measurements before `index`.
  void drop_before(std::uint64_t index);
  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::uint64_t index = 0;
    sim::Snapshot snapshot;
  };
  std::vector<Entry> entries_;
  std::vector<Entry> spare_;
};

}  // namespace tether::coordinator

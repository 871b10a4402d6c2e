#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <tether/sim/simulator.h>

namespace tether::coordinator {

using SharedState = std::shared_ptr<const sim::Snapshot>;

/// The simulator's state at the present ST, captured at most once for all sensors of all UAVs that
/// sample it. Storage that nobody refers to any more is reused, so that steady use allocates
/// nothing.
class StatePool {
 public:
  SharedState at(SimTime st, const std::function<void(sim::Snapshot&)>& capture);

 private:
  std::shared_ptr<sim::Snapshot>& take_unused();

  std::vector<std::shared_ptr<sim::Snapshot>> states_;
  std::size_t last_taken_ = 0;
  SharedState latest_;
  SimTime latest_at_{};
};

/// The captured states of one periodic sensor that may still be read: a few, in the order of their
/// indices.
class CaptureStore {
 public:
  /// @pre `index` is greater than every earlier one.
  void add(std::uint64_t index, SharedState state);
  /// nullptr if that state was not captured, or was dropped.
  const sim::Snapshot* find(std::uint64_t index) const;
  /// Drops the states of measurements before `index`.
  void drop_before(std::uint64_t index);
  std::size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    std::uint64_t index = 0;
    SharedState state;
  };
  std::vector<Entry> entries_;
};

}  // namespace tether::coordinator

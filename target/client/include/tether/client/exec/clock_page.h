#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/os/file_descriptor.h>

namespace tether::client {

/// The current course of ET: `base_et` at `base_mono`, then `factor` times as fast as the machine's
/// clock; or stopped.
struct ClockState {
  ExecTime base_et;
  Duration base_mono{0};  ///< of CLOCK_MONOTONIC
  double factor = 1.0;    ///< > 0
  bool running = false;

  ExecTime at(Duration mono) const;
  /// The time at which ET is `et`, rounded up. @pre running
  Duration mono_at(ExecTime et) const;
  friend bool operator==(const ClockState&, const ClockState&) = default;
};

/// The ET of a group of processes in shared memory: one process writes it, any number read it
/// without locks. No reader waits for the writer.
///
/// The writer fills the unused slot and publishes it. A reader takes the published slot, reads the
/// machine's clock, and repeats if another slot was published in between. So a reader that is
/// frozen between the two steps does not count the freeze as ET.
class ClockPage {
 public:
  ClockPage() = default;
  ClockPage(const ClockPage&) = delete;
  ClockPage& operator=(const ClockPage&) = delete;

  /// One writer at a time.
  void publish(const ClockState& state);
  /// The last published state. For the writer, and for tests.
  ClockState state() const;
  /// ET now; `monotonic` reads the clock of the states.
  template <class Monotonic>
  ExecTime now(Monotonic monotonic) const {
    while (true) {
      const std::uint32_t published = published_.load(std::memory_order_acquire);
      const ClockState state = load(slots_[published % 2]);
      const Duration mono = monotonic();
      if (published_.load(std::memory_order_relaxed) == published) return state.at(mono);
    }
  }
  ExecTime now() const;

 private:
  // Stores to a slot release and loads acquire: a reader that sees part of a later state also sees
  // that the state before it was published.
  struct Slot {
    std::atomic<std::int64_t> base_et_ns{0};
    std::atomic<std::int64_t> base_mono_ns{0};
    std::atomic<double> factor{1.0};
    std::atomic<bool> running{false};
  };
  static ClockState load(const Slot& slot);

  std::atomic<std::uint32_t> published_{0};
  std::array<Slot, 2> slots_;

  static_assert(std::atomic<std::int64_t>::is_always_lock_free &&
                std::atomic<double>::is_always_lock_free);
};

/// This machine's CLOCK_MONOTONIC.
Duration read_monotonic();

/// A page in new memory, which other processes can map read-only through `descriptor`. Fails with
/// kInvalid and the error of the system.
struct SharedClockPage {
  struct Unmap {
    void operator()(ClockPage* mapped) const;
  };
  std::unique_ptr<ClockPage, Unmap> page;
  os::FileDescriptor descriptor;
};
Result<SharedClockPage> make_clock_page();

/// The same page in another process. Fails with kProtocol if `descriptor` is not a clock page.
struct MappedClockPage {
  struct Unmap {
    void operator()(const ClockPage* mapped) const;
  };
  std::unique_ptr<const ClockPage, Unmap> page;
};
Result<MappedClockPage> map_clock_page(const os::FileDescriptor& descriptor);

}  // namespace tether::client

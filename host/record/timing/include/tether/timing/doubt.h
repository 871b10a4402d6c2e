#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tether::timing {

/// What a run did not see or could not measure well, so that its verdict may be wrong. The part of
/// it that follows from the files is Warning::can_change_verdict.
struct Doubt {
  enum class Kind {
    kUnseenWait,       ///< the program waited on something that Tether does not see; amount: s,
                       ///< on the modelled computer at most, as if something else computed
    kParallelThreads,  ///< threads computed in parallel, but their times were added; amount: CPU
                       ///< time over wall time, > 1
    kDiskWait,         ///< the program waited for the disk, which its clock does not count; s
    kStretchedWait,    ///< the program waited, and a factor made more of it; s, as it was
    kSlightWait,       ///< as the first, too short to matter unless a limit is as close; amount:
                       ///< share of its time
    kBusyMachine,  ///< the machine was busy or uneven; amount: the share by which its times can be
                   ///< off
  };
  Kind kind = Kind::kUnseenWait;
  std::string subject;  ///< the UAV of the program, or the board; empty: this machine
  double amount = 0.0;
  /// The timing file whose times are replayed, if it is a doubt of the runs in which they were
  /// measured; empty: of this run.
  std::string recorded_in{};

  /// Without this one, the times would be other ones: nothing is known of the computer. Otherwise
  /// the amount says by how much they can be off.
  bool is_of_unseen_time() const { return kind < Kind::kSlightWait; }

  friend bool operator==(const Doubt&, const Doubt&) = default;
};
inline constexpr std::size_t kDoubts = 6;  ///< kinds
/// "unseen_wait", "parallel_threads", "disk_wait", "stretched_wait", "slight_wait",
/// "busy_machine".
std::string_view name(Doubt::Kind kind);

}  // namespace tether::timing

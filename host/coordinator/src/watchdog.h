#pragma once

#include "diagnosis.h"
#include "validator.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tether/coordinator/coordinator.h>
#include <tether/link/messages.h>

namespace tether::coordinator {

/// Why a run is over.
struct Ending {
  RunEnd how = RunEnd::kFinished;
  std::string reason;  ///< one line; names the cause
};

/// Whether a message is a sign of life. Under the barrier, progress is sent by a helper thread, and
/// the SUT itself may be stuck. If it computes, its CPU time grows. A wall clock always grows, so
/// it counts only while a call is open. Annotations do not count: a SUT could send them for ever.
bool shows_life(const link::Message& message, const Standing& sut, link::ClockKind clock);

/// Detects that a run takes too long or that a SUT is silent for too long, and describes who is
/// blocked on whom. Pure: times are arguments. The barrier does not depend on it.
class Watchdog {
 public:
  struct Limits {
    SimTime st;        ///< of the run
    Duration connect;  ///< of WT until every SUT has joined
    Duration hang;     ///< of WT without a sign of life from a SUT that computes
  };

  Watchdog(const Limits& limits, std::size_t suts, bool tied, WallTime now);

  /// Every SUT has joined.
  void begin(WallTime now);
  /// ST advanced, a reply was sent, or a SUT joined.
  void moved(WallTime now) { moved_ = now; }
  /// A SUT gave a sign of life, or a reply was sent to it.
  void heard(std::size_t sut, WallTime now) { last_heard_[sut] = now; }

  /// Whether the limits have to be checked again; call it once per turn of the loop. Time in which
  /// it was not called (the process was stopped, say) does not count as silence.
  bool is_due(WallTime now);
  /// Time since its last sign of life; before it has joined, since the start.
  Duration silence(std::size_t sut, WallTime now) const { return now - last_heard_[sut]; }

  /// The end of the run if ST has reached its limit.
  std::optional<Ending> over_time(SimTime st) const;
  /// The end of the run if a SUT has not joined in time or is hung. `parties`: all SUTs in the
  /// world's order.
  std::optional<Ending> overdue(const std::vector<Party>& parties, SimTime st) const;
  /// If nothing has moved for a second: who is blocked on whom, or which SUTs have not joined.
  std::string blocked(const std::vector<Party>& parties, SimTime st, WallTime now) const;

 private:
  std::optional<Ending> overdue(const Party& party, const std::vector<Party>& parties,
                                SimTime st) const;
  void pardon(Duration unheard, WallTime now);

  Limits limits_;
  bool tied_;
  bool running_ = false;
  std::vector<WallTime> last_heard_;  // of each SUT
  WallTime moved_;
  WallTime looked_;
};

}  // namespace tether::coordinator

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
  std::string reason;  ///< one line; names the culprit
};

/// Whether a message shows that the SUT lives. Under the barrier a progress may not: its sender is
/// a helper, and the SUT itself may be stuck. That it has computed shows in CPU time, which then
/// goes on; the wall clock goes on whatever the SUT does, so there only its calls tell, as long as
/// none of them is open. Annotations tell nothing: a SUT could go on with them for ever.
bool shows_life(const link::Message& message, const Standing& sut, link::ClockKind clock);

/// Ends a run that takes too long, or in which a SUT is silent for too long, and says who waits for
/// whom where nothing moves. Pure: times are arguments. None of it reaches a decision of the
/// barrier.
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
  /// ST went on, a reply left, or a SUT joined.
  void moved(WallTime now) { moved_ = now; }
  /// A SUT has shown life, or has been told to go on.
  void heard(std::size_t sut, WallTime now) { last_heard_[sut] = now; }

  /// Whether it is time to look at the limits again; called once per turn of the loop. Time in
  /// which it was not called is nobody's silence.
  bool is_due(WallTime now);
  /// Since it was heard last; before it has joined, since it is waited for.
  Duration silence(std::size_t sut, WallTime now) const { return now - last_heard_[sut]; }

  /// The run's end, if ST has come to its limit.
  std::optional<Ending> over_time(SimTime st) const;
  /// The run's end, if a SUT is overdue. `parties`: all SUTs in the world's order.
  std::optional<Ending> overdue(const std::vector<Party>& parties, SimTime st) const;
  /// Who blocks whom, or whose SUT has not joined, where nothing has moved for a second; else
  /// empty.
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

#pragma once

#include "sessions/validator.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <tether/coordinator/coordinator.h>
#include <tether/link/messages.h>

namespace tether::coordinator {

/// The state of one SUT, for messages.
struct Party {
  std::string sut;  ///< its name from the Hello
  std::string uav;
  bool joined = true;
  bool computing = false;              ///< the coordinator waits for its next message
  std::optional<ExecTime> bound{};     ///< ET that it is known to have reached; see Timeline::et
  Duration silence{0};                 ///< WT since its last sign of life
  std::optional<ExecTime> reply_at{};  ///< of its open calls the earliest
  bool counted = false;                ///< its work is counted, and a sign of life
  std::uint32_t received_bytes = 0;    ///< of a reply that takes long to arrive
  std::string computer{};              ///< on which it runs; empty: all on the same
  bool as_is = false;                  ///< it does not use Tether's library
};

/// "it was computing; last message at ET 1.200000 s"
std::string describe_state(const Party& party);
/// Which SUT blocks the run, for how long, and which SUTs wait for it; one sentence. Empty if all
/// wait for the simulator, and in free running.
std::string describe_blocking(SimTime st, const std::vector<Party>& parties);

/// Whether a message is a sign of life. Under the barrier, progress is sent by a helper thread, and
/// the SUT itself may be stuck. If it computes, its CPU time grows. A wall clock always grows, so
/// it counts only while a call is open. More bytes of a reply count. Annotations do not count: a
/// SUT could send them for ever.
bool shows_life(const link::Message& message, const Standing& sut, computer::ClockKind clock);

/// Detects that a run takes too long or that a SUT is silent for too long, and describes which SUT
/// is blocked on which. Pure: times are arguments. The barrier does not depend on it.
class Watchdog {
 public:
  struct Limits {
    SimTime st;        ///< of the run
    Duration connect;  ///< of WT until every SUT has joined
    Duration hang;     ///< of WT without a sign of life from a SUT that computes
  };

  Watchdog(const Limits& limits, std::size_t suts, WallTime now);

  /// That of the run: a step boundary.
  SimTime st_limit() const { return limits_.st; }

  /// Every SUT has joined.
  void begin(WallTime now);
  /// ST advanced, a reply was sent, or a SUT joined.
  void moved(WallTime now) { moved_ = now; }
  /// A SUT gave a sign of life, a reply was sent to it, or a message in transit moved on.
  void heard(std::size_t sut, WallTime now) { last_heard_[sut] = now; }

  /// Whether the limits have to be checked again; call it once per turn of the loop. Time in which
  /// it was not called (because the process was stopped, for example) does not count as silence.
  bool is_due(WallTime now);
  /// Time since its last sign of life; before it has joined, since the start.
  Duration silence(std::size_t sut, WallTime now) const { return now - last_heard_[sut]; }

  /// The end of the run if ST has reached its limit.
  std::optional<Ending> over_time(SimTime st) const;
  /// The end of the run if a SUT has not joined in time or is hung. `parties`: all SUTs in the
  /// world's order.
  std::optional<Ending> overdue(const std::vector<Party>& parties, SimTime st) const;
  /// If nothing has moved for a second: which SUT blocks the run, or which SUTs have not joined.
  std::string blocked(const std::vector<Party>& parties, SimTime st, WallTime now) const;

 private:
  void discount(Duration unwatched, WallTime now);

  Limits limits_;
  bool running_ = false;
  std::vector<WallTime> last_heard_;  // of each SUT
  WallTime moved_;
  WallTime checked_;
};

}  // namespace tether::coordinator

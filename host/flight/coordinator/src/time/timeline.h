#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>

#include <tether/link/messages.h>
#include <tether/record/messages.h>
#include <tether/sync/barrier_synchronizer.h>
#include <tether/sync/clock_plausibility.h>

namespace tether::coordinator {

/// A message that a SUT stamps, and the ST and WT of its arrival.
struct Sent {
  std::variant<link::Annotation, link::Request> message;
  SimTime st;
  WallTime wall;
  std::size_t uav = 0;
  ExecTime at{};  ///< its instant, once that is known
  /// On a modelled board: computed since the SUT resumed, as if alone.
  std::optional<Duration> work{};

  ExecTime stamp() const {
    if (const auto* note = std::get_if<link::Annotation>(&message)) return note->at;
    return std::get<link::Request>(message).issued_at;
  }
};

/// The time of one SUT. How it is known, and when the SUT may go on, is a case of this type
/// (Timelines::begin chooses it); the coordinator's loop is the same for all of them:
///
///     send → arrive → hold → (move_up) → Timelines::release → replied → send → …
///
/// Meanwhile `progress` and `read_timer` raise its bound. This class itself is the time of a SUT
/// that has not begun: nothing happens. Pure: times are arguments. Not thread-safe.
class Timeline {
 public:
  /// What does not change in a run.
  struct Facts {
    bool is_serial = true;         ///< one call at a time
    bool is_stamped = false;       ///< by the SUT's side
    bool repeats = false;          ///< the same in each run
    bool may_wait_unseen = false;  ///< ET does not grow while it waits on what is no interaction
    bool shares_board = false;     ///< with other SUTs; its ET depends on theirs
    /// It uses one core from a reply until its next request.
    bool loads_one_core() const { return is_serial && !shares_board; }
  };

  explicit Timeline(std::size_t uav) : uav_(uav) {}
  virtual ~Timeline() = default;
  Timeline(const Timeline&) = delete;
  Timeline& operator=(const Timeline&) = delete;

  const Facts& facts() const { return facts_; }

  /// Lower bound on its ET; of a held serial SUT, the timestamp of its reply. None before it has
  /// begun, and in free running.
  virtual std::optional<ExecTime> et() const { return std::nullopt; }
  /// The same; 0 if there is none.
  ExecTime bound() const { return et().value_or(ExecTime{}); }
  /// The same by the SUT's own count, which on a modelled board is behind its ET.
  virtual std::optional<ExecTime> last_stamp() const { return et(); }
  /// Timestamp of its last reply, from which on it computes.
  ExecTime resumed_at() const { return resumed_at_; }
  /// Whether the coordinator waits for its next message.
  virtual bool is_computing() const { return false; }
  /// As sync::BarrierSynchronizer::is_held.
  virtual bool is_held() const { return false; }
  bool has_left() const { return has_left_; }
  /// Its requests at this ST; 0 in free running, where ST follows the wall clock.
  virtual std::size_t calls_at(SimTime) const { return 0; }
  /// WT from its last request to the reply; 0: none yet, or its calls overlap.
  Duration last_hold() const { return last_hold_; }
  /// A request that has arrived, and whose instant is not known yet; nullptr: none.
  virtual const link::Request* unsettled() const { return nullptr; }
  /// Checks its stamps; nullptr: they cannot be checked.
  virtual const sync::ClockPlausibility* plausibility() const { return nullptr; }

  /// A stop of a concurrent SUT that has not been reported before.
  struct Stop {
    ExecTime at;
    std::optional<ExecTime> due{};  ///< timestamp of the reply that caused it
  };
  /// Ignored if its ET is not its client's. @pre valid (validator.h).
  virtual std::optional<Stop> progress(const link::Progress&) { return std::nullopt; }
  /// Some WT has passed.
  virtual void read_timer(WallTime) {}

  /// It has sent a message. Returns it if its instant is known at once; otherwise
  /// Timelines::settle gives it later. @pre valid.
  virtual std::optional<Sent> send(Sent sent) {
    sent.at = sent.stamp();
    return sent;
  }
  /// A request at its instant. @pre returned by `send`, or settled.
  virtual sync::Arrival arrive(const Sent& sent) { return {.charged_at = sent.at}; }
  /// Its reply is planned. Returns what the SUT must know of it. @pre after `arrive`.
  virtual std::optional<link::Due> hold(const record::Interaction&) { return std::nullopt; }
  /// A message has arrived for a held `receive`: its reply is due at `reply_at` already.
  virtual std::optional<link::Due> move_up(sync::CallId, ExecTime) { return std::nullopt; }
  /// Its reply was sent, as the entry says. @pre Timelines::release has granted it.
  virtual void replied(const record::Interaction& call) {
    resumed_at_ = call.reply_at;
    if (facts_.is_serial) last_hold_ = call.wall_at_release - call.wall_at_arrival;
  }
  /// It has finished or was disconnected; its open calls are dropped.
  virtual void leave() { has_left_ = true; }

 protected:
  Timeline(std::size_t uav, const Facts& facts) : uav_(uav), facts_(facts) {}
  std::size_t uav() const { return uav_; }

 private:
  std::size_t uav_;
  Facts facts_;
  ExecTime resumed_at_{};
  Duration last_hold_{0};
  bool has_left_ = false;
};

}  // namespace tether::coordinator

#pragma once

#include <optional>

#include <tether/base/time.h>

namespace tether::supervisor {

/// Whether the command must be stopped because its request to join is not yet answered: its
/// threads' computation would not count as ET. Pure logic; all instants are of one clock.
class Joining {
 public:
  /// Without an answer within `limit` the command continues, and its own timeouts apply.
  explicit Joining(Duration limit) : limit_(limit) {}

  void asked(Duration now) { asked_at_ = now; }
  /// It has not asked yet, and can still do so.
  bool is_to_come() const { return !asked_at_ && !over_; }
  /// After Welcome, refusal, a lost connection or an interrupt; permanent.
  void over() { over_ = true; }

  bool must_be_stopped(Duration now) const { return until() && now < *until(); }
  /// Until when it must be stopped at most, if at all.
  std::optional<Duration> until() const {
    if (!asked_at_ || over_) return std::nullopt;
    return *asked_at_ + limit_;
  }

 private:
  Duration limit_;
  std::optional<Duration> asked_at_;
  bool over_ = false;
};

}  // namespace tether::supervisor

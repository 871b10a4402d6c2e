#pragma once

#include <optional>

#include <tether/base/time.h>

namespace tether::supervisor {

/// Whether the command must stand still because it has asked to join and not been answered: what
/// its threads computed meanwhile would be charged to nobody. Pure; instants on one clock.
class Joining {
 public:
  /// No answer within `limit`: the command goes on, and its own time-outs decide.
  explicit Joining(Duration limit) : limit_(limit) {}

  void asked(Duration now) { asked_at_ = now; }
  /// Welcome, refusal, a lost connection or an interrupt: for good.
  void over() { over_ = true; }

  bool must_stand_still(Duration now) const { return until() && now < *until(); }
  /// The latest instant until which it stands still, if it does.
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

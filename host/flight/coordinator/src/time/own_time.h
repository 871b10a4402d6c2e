#pragma once

#include "time/timeline.h"

#include <memory>

namespace tether::coordinator {

/// A SUT under the barrier when the run begins.
struct SutStart {
  std::size_t uav = 0;
  const link::Hello& hello;
  int cores = 0;  ///< of its machine; 0: not known
  WallTime now;
  sync::BarrierSynchronizer& barrier;  ///< outlives the Timeline, and does not have the SUT yet
  Duration least_delay{0};             ///< of a message by radio
};

/// The time of a serial SUT that has its computer to itself: the stamps of its clock, checked
/// against the coordinator's.
class OwnTime : public Timeline {
 public:
  explicit OwnTime(const SutStart& sut) : OwnTime(sut, facts_of(sut.hello.clock)) {}

  std::optional<ExecTime> et() const override { return barrier_->bound(uav()); }
  bool is_computing() const override { return !has_left() && !is_held(); }
  bool is_held() const override { return barrier_->is_held(uav()); }
  const sync::ClockPlausibility* plausibility() const override {
    return plausibility_ ? &*plausibility_ : nullptr;
  }
  std::size_t calls_at(SimTime st) const override { return st > called_at_ ? 0 : calls_; }
  std::optional<Stop> progress(const link::Progress& progress) override {
    barrier_->progress(uav(), progress.reached);
    return std::nullopt;
  }
  sync::Arrival arrive(const Sent& sent) override { return arrive_at(sent.at, sent.st); }
  std::optional<link::Due> hold(const record::Interaction& call) override {
    barrier_->hold({uav(), call.reply_at, call.sequence,
                    call.receive_until ? std::optional(least_delay_) : std::nullopt});
    return std::nullopt;
  }
  std::optional<link::Due> move_up(sync::CallId call, ExecTime reply_at) override {
    barrier_->move_up(uav(), call, reply_at);
    return std::nullopt;
  }
  // A CPU clock adds what child processes computed during the call, which the SUT can have sent as
  // soon as it had the reply before.
  void replied(const record::Interaction& call) override {
    Timeline::replied(call);
    if (plausibility_)
      plausibility_->go_on(barrier_->bound(uav()),
                           charges_children_ ? released_at_ : call.wall_at_release);
    released_at_ = call.wall_at_release;
  }
  void leave() override {
    Timeline::leave();
    barrier_->remove(uav());
  }

 protected:
  OwnTime(const SutStart& sut, const Facts& facts);
  static Facts facts_of(const computer::Clock& clock);
  sync::BarrierSynchronizer& barrier() { return *barrier_; }
  sync::Arrival arrive_at(ExecTime stamp, SimTime st) {
    calls_ = calls_at(st) + 1;
    called_at_ = st;
    return barrier_->arrive(uav(), stamp, st);
  }

 private:
  sync::BarrierSynchronizer* barrier_;
  Duration least_delay_;
  bool charges_children_;  // for what they compute during a call
  WallTime released_at_;   // its last reply was sent
  SimTime called_at_{};    // ST of its last request
  std::size_t calls_ = 0;  // requests at that ST
  std::optional<sync::ClockPlausibility> plausibility_;
};

/// The time of a serial SUT whose client does not stamp: the coordinator times it, as in the paper.
std::unique_ptr<Timeline> make_unstamped_time(const SutStart& sut);

/// The time of a concurrent SUT: it runs while calls are open, and stops when a reply is due. It is
/// alone on its computer, or in the group of a real board, which is stopped as one (DESIGN section
/// 2, "Several threads", "Several programs on one board").
std::unique_ptr<Timeline> make_concurrent_time(const SutStart& sut, bool is_in_group);

}  // namespace tether::coordinator

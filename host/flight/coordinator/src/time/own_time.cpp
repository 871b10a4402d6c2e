#include "time/own_time.h"

#include "time/execution_timer.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace tether::coordinator {
namespace {

/// How fast the SUT's clock can run; none if it is the coordinator's own, scripted or counted.
std::optional<sync::ClockBound> bound_of(const computer::Clock& clock, int cores) {
  if (clock.adds_up_cores()) return sync::cpu_bound(clock.factor, cores);
  if (clock.kind == computer::ClockKind::kWall) return sync::wall_bound(clock.factor);
  return std::nullopt;
}

class UnstampedTime final : public OwnTime {
 public:
  explicit UnstampedTime(const SutStart& sut) : OwnTime(sut, {}), timer_(ExecTime{}, sut.now) {}

  std::optional<Stop> progress(const link::Progress&) override { return std::nullopt; }
  // It may let ST advance for another SUT.
  void read_timer(WallTime now) override {
    if (is_computing()) barrier().progress(uav(), timer_.read(now));
  }
  sync::Arrival arrive(const Sent& sent) override {
    return arrive_at(timer_.pause(sent.wall), sent.st);
  }
  void replied(const record::Interaction& call) override {
    OwnTime::replied(call);
    timer_.resume(call.wall_at_release, call.reply_at);
  }

 private:
  ExecutionTimer timer_;
};

class ConcurrentTime final : public OwnTime {
 public:
  ConcurrentTime(const SutStart& sut, bool is_in_group)
      : OwnTime(sut, {.is_serial = false, .is_stamped = true, .shares_board = is_in_group}) {}

  // At a stop, replies that are due by then can be sent. It reports the same stop again if a
  // message has moved up the reply that it waits for.
  std::optional<Stop> progress(const link::Progress& progress) override {
    if (!progress.stopped) return OwnTime::progress(progress);
    barrier().stop(uav(), progress.reached, progress.dues_heard >= newest_moved_due_);
    if (std::exchange(stopped_at_, progress.reached) == progress.reached) return std::nullopt;
    return Stop{progress.reached, earliest_due(progress)};
  }
  // It receives the time of its reply at once, so that its other threads can run until then.
  std::optional<link::Due> hold(const record::Interaction& call) override {
    OwnTime::hold(call);
    calls_.push_back({call.sequence, call.reply_at});
    ++dues_sent_;
    return link::Due{call.sequence, call.reply_at};
  }
  std::optional<link::Due> move_up(sync::CallId call, ExecTime reply_at) override {
    Call& open = *std::ranges::find(calls_, call, &Call::id);
    if (reply_at == open.reply_at) return std::nullopt;
    OwnTime::move_up(call, reply_at);
    newest_moved_due_ = ++dues_sent_;
    open = {call, reply_at, newest_moved_due_};
    return link::Due{call, reply_at};
  }
  void replied(const record::Interaction& call) override {
    OwnTime::replied(call);
    std::erase_if(calls_, [&](const Call& open) { return open.id == call.sequence; });
  }

 private:
  struct Call {
    sync::CallId id = 0;
    ExecTime reply_at;
    std::uint64_t moved_due = 0;  // number of the Due that moved its reply up; 0: none did
  };

  // The timestamp of the reply that caused a stop. No reply is sent before the SUT has stopped for
  // it, so it is one of the open calls that are due, and that the SUT knew to be due.
  std::optional<ExecTime> earliest_due(const link::Progress& stop) const {
    std::optional<ExecTime> earliest;
    for (const Call& call : calls_)
      if (call.reply_at <= stop.reached && call.moved_due <= stop.dues_heard)
        earliest = std::min(earliest.value_or(call.reply_at), call.reply_at);
    return earliest;
  }

  std::vector<Call> calls_;             // open, in the order of their requests
  std::optional<ExecTime> stopped_at_;  // ET of the last stop
  std::uint64_t dues_sent_ = 0;
  std::uint64_t newest_moved_due_ = 0;
};

}  // namespace

std::unique_ptr<Timeline> make_unstamped_time(const SutStart& sut) {
  return std::make_unique<UnstampedTime>(sut);
}

std::unique_ptr<Timeline> make_concurrent_time(const SutStart& sut, bool is_in_group) {
  return std::make_unique<ConcurrentTime>(sut, is_in_group);
}

Timeline::Facts OwnTime::facts_of(const computer::Clock& clock) {
  return {.is_stamped = true,
          .repeats = clock.repeats(),
          .may_wait_unseen = !clock.counts_waiting_as_it_is()};
}

OwnTime::OwnTime(const SutStart& sut, const Facts& facts)
    : Timeline(sut.uav, facts),
      barrier_(&sut.barrier),
      least_delay_(sut.least_delay),
      charges_children_(sut.hello.clock.adds_up_cores()),
      released_at_(sut.now) {
  [[maybe_unused]] const sync::SutIndex index = barrier_->add(
      ExecTime{}, facts.is_serial ? sync::SutKind::kSerial : sync::SutKind::kConcurrent);
  assert(index == sut.uav);
  if (const auto bound = bound_of(sut.hello.clock, sut.cores))
    plausibility_.emplace(*bound, ExecTime{}, sut.now);
}

}  // namespace tether::coordinator

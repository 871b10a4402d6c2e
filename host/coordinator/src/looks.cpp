#include "coordinator_impl.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

/// Looks at what the threads of SUTs do while they should compute: an estimate, by samples, of how
/// long a SUT waits on what is no interaction, and on how many threads it computes. Only the report
/// has it, because it is measured.
namespace tether::coordinator {

namespace {

// A wait of 20 ms is then seen ten times.
constexpr Duration kLookPeriod = std::chrono::milliseconds(2);
// A look takes some 20 µs for each thread. Programs with many threads are looked at more rarely, so
// that looking takes 2 % of a core at most, but often enough for a wait of a second.
constexpr int kPeriodPerCost = 50;
constexpr Duration kLongestPeriod = std::chrono::milliseconds(50);
// A SUT sends no more at once, unless it floods the coordinator.
constexpr int kMostPolls = 8;

}  // namespace

void SutLooks::add(const ThreadStates& states, Duration represented) {
  if (states.runnable > 0) {
    computing += represented;
    of_all_threads += states.runnable * represented;
    if (states.runnable > 1) ++parallel_looks;
  } else if (!states.is_halted) {
    (states.is_on_disk ? on_disk : waiting) += represented;
  }
}

Duration Coordinator::Impl::until_look() const {
  if (!running_ || std::ranges::none_of(
                       sessions_, [&](const Session& session) { return is_looked_at(session); }))
    return Duration::max();
  return std::max(next_look_ - host_clock_(), Duration(0));
}

bool Coordinator::Impl::is_looked_at(const Session& session) const {
  const Timeline& time = time_of(session);
  return hooks_.threads_of && time.facts().may_wait_unseen && time.is_computing() &&
         !session.is_hidden;
}

// What a SUT does is known only if it has sent nothing by then: it may have been looked at while it
// already waited for a reply. If it began to compute after the instant at which a look was due, it
// was not computing then.
void Coordinator::Impl::look_at_suts() {
  if (!hooks_.threads_of || !running_) return;
  const WallTime now = host_clock_();
  if (now < next_look_) return;
  const Duration passed = look_period_ * ((now - next_look_) / look_period_ + 1);
  // If this process was late itself, nothing is known of the time in which it did not look.
  const Duration represented = look_period_;
  struct Look {
    Session& session;
    WallTime since;
    ThreadStates states;
  };
  std::vector<Look> looks;
  for (Session& session : sessions_) {
    if (!is_looked_at(session) || session.computes_since > next_look_) continue;
    const auto states = hooks_.threads_of(session.uav);
    session.is_hidden = !states;
    if (states) looks.push_back({session, session.computes_since, *states});
  }
  next_look_ += passed;
  if (looks.empty()) return;
  // One that was interrupted changes little.
  look_period_ = std::clamp(kPeriodPerCost * (host_clock_() - now), kLookPeriod,
                            std::min(2 * look_period_, kLongestPeriod));
  for (int i = 0; i < kMostPolls && !ended_; ++i) {
    const auto events = server_->poll(Duration(0));
    if (events.empty()) break;
    for (const link::Event& event : events) on_event(event);
  }
  for (const Look& look : looks)
    if (is_looked_at(look.session) && look.session.computes_since == look.since) {
      look.session.looks.add(look.states, represented);
      end_unseen_wait(look.session);
    }
}

// A program that waits in small steps computes a little between them, and that is a sign of life.
void Coordinator::Impl::end_unseen_wait(const Session& session) {
  const Duration waited = session.looks.waiting - session.waited_before;
  if (waited <= options_.hang_limit) return;
  end({RunEnd::kSutHung,
       fmt::format("SUT \"{}\" of UAV \"{}\" timed out: after its last call it waited {} s "
                   "(hang_limit_s) on something that Tether does not see",
                   session.hello.sut, session.uav_name, to_seconds(options_.hang_limit))});
}

}  // namespace tether::coordinator

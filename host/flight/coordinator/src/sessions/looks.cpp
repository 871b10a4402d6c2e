#include "sessions/looks.h"

#include <algorithm>
#include <utility>

namespace tether::coordinator {

namespace {

// A wait of 20 ms is then seen ten times.
constexpr Duration kLookPeriod = std::chrono::milliseconds(2);
// A look takes some 20 µs for each thread. Programs with many threads are looked at more rarely, so
// that looking takes 2 % of a core at most, but often enough for a wait of a second.
constexpr int kPeriodPerCost = 50;
constexpr Duration kLongestPeriod = std::chrono::milliseconds(50);

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

void ThreadLooks::begin(ThreadsOf threads_of, WallTime now) {
  threads_of_ = std::move(threads_of);
  next_ = now;
}

void ThreadLooks::computes(std::size_t uav, WallTime now) {
  suts_[uav].computes_since = now;
  suts_[uav].waited_before = suts_[uav].looks.waiting;
  suts_[uav].waits = false;
}

Duration ThreadLooks::until_due(const std::function<WallTime()>& clock) const {
  for (std::size_t uav = 0; threads_of_ && uav < suts_.size(); ++uav)
    if (is_looked_at(uav)) return std::max(next_ - clock(), Duration(0));
  return Duration::max();
}

// What a SUT does is known only if it has sent nothing by then: it may have been looked at while it
// already waited for a reply. If it began to compute after the instant at which a look was due, it
// was not computing then.
std::vector<ThreadLooks::Look> ThreadLooks::look(const std::function<WallTime()>& clock) {
  std::vector<Look> looks;
  const WallTime now = threads_of_ ? clock() : WallTime::min();
  if (now < next_) return looks;
  const Duration passed = period_ * ((now - next_) / period_ + 1);
  // If this process was late itself, nothing is known of the time in which it did not look.
  represented_ = period_;
  for (std::size_t uav = 0; uav < suts_.size(); ++uav) {
    Sut& sut = suts_[uav];
    if (!is_looked_at(uav) || sut.computes_since > next_) continue;
    const auto states = threads_of_(uav);
    sut.is_hidden = !states;
    if (states) looks.push_back({uav, sut.computes_since, *states});
  }
  next_ += passed;
  // One that was interrupted changes little.
  if (!looks.empty())
    period_ = std::clamp(kPeriodPerCost * (clock() - now), kLookPeriod,
                         std::min(2 * period_, kLongestPeriod));
  return looks;
}

Duration ThreadLooks::count(const Look& look) {
  Sut& sut = suts_[look.uav];
  if (!is_looked_at(look.uav) || sut.computes_since != look.since) return Duration(0);
  // A program that waits for the client library computed before, or does so afterwards.
  if (look.states.is_served && look.states.runnable == 0) {
    sut.served += represented_;
    return Duration(0);
  }
  const Duration before = sut.looks.waiting;
  sut.looks.add(look.states, represented_);
  const bool waits = sut.looks.waiting > before;
  if (waits && sut.waits) sut.looks.waiting += sut.served;
  sut.served = Duration(0);
  sut.waits = waits;
  return sut.looks.waiting - sut.waited_before;
}

}  // namespace tether::coordinator

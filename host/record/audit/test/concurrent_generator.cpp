#include "concurrent_generator.h"

#include "altered_record.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <tether/base/random.h>

namespace tether::audit {
namespace {

using record::Interaction;
using record::Record;

constexpr std::int64_t kStep_ns = 1'000'000;
constexpr std::int64_t kPeriod_ns = 33'333'333;
constexpr std::int64_t kPhase = 1'234'567;
constexpr std::int64_t kDelay = 12'345'678;
constexpr std::int64_t kMostRangeDelay_ns = 60'000'000;

class ConcurrentHost {
 public:
  explicit ConcurrentHost(const ConcurrentOptions& options)
      : options_(options), random_({options.seed, 77, 0}) {
    threads_.resize(static_cast<std::size_t>(options.threads));
    for (Thread& thread : threads_) thread.asks_at = compute(0);
  }

  Record run() {
    make_header();
    while (!finished_) run_to_stop();
    make_footer();
    return std::move(record_);
  }

 private:
  struct Thread {
    std::int64_t asks_at = 0;           // while it computes
    std::optional<Interaction> open{};  // its call
  };

  void make_header() {
    record_.header.policy = record::kConservativeBarrier;
    record_.header.step = Duration(kStep_ns);
    record_.header.seed = options_.seed;
    record_.header.suts = {{"a",
                            "test",
                            {computer::ClockKind::kWall, options_.wall_factor},
                            Duration(1'700'000),
                            true}};
    record_.header.sensors = {
        {"a", "camera", "camera", true, Duration(kPeriod_ns), Duration(kPhase), Duration(kDelay),
         Duration(kDelay)},
        {"a", "range", "range", false, {}, {}, {}, Duration(kMostRangeDelay_ns)}};
  }

  std::int64_t below(std::int64_t bound) {
    return static_cast<std::int64_t>(random_.uniform() * static_cast<double>(bound));
  }
  std::int64_t compute(std::int64_t from) {
    const std::int64_t at = from + 1 + below(random_.bits() % 4 == 0 ? 20'000'000 : 900'000);
    return random_.bits() % 8 == 0 ? ceil_ns(at, kStep_ns) : at;
  }

  void run_to_stop() {
    std::int64_t end = std::numeric_limits<std::int64_t>::max();
    for (const Thread& t : threads_) end = std::min(end, t.open ? reply_of(t) : t.asks_at);
    const std::int64_t stop = end + (random_.bits() % 2 ? below(700'000) : 0);
    wall_ += static_cast<std::int64_t>(static_cast<double>(stop - et_) / options_.wall_factor) + 1;
    et_ = stop;

    std::vector<Thread*> asking;
    for (Thread& t : threads_)
      if (!t.open && t.asks_at <= et_) asking.push_back(&t);
    std::ranges::stable_sort(asking, {}, &Thread::asks_at);
    for (Thread* t : asking) arrive(*t);
    log_stop();
    release_due();
  }

  static std::int64_t reply_of(const Thread& thread) { return to_ns(thread.open->reply_at); }

  // ST advances by a random amount, at most to `limit` and to where a reply is due.
  void drift(std::int64_t limit) {
    for (const Thread& t : threads_)
      if (t.open) limit = std::min(limit, floor_ns(reply_of(t), kStep_ns));
    limit = floor_ns(limit, kStep_ns);
    advance(st_ + below((limit - st_) / kStep_ns + 1) * kStep_ns);
  }
  void advance(std::int64_t st) {
    st_ = st;
    while (!effects_.empty() && effects_.begin()->first <= st_) {
      const SimTime at = from_ns<SimTime>(effects_.begin()->first);
      record_.commands.push_back({at, order_++, {"a", effects_.begin()->second, at, 1, 0, 0, 0}});
      effects_.erase(effects_.begin());
    }
  }

  void arrive(Thread& thread) {
    drift(thread.asks_at);
    Interaction m;
    m.uav = "a";
    m.sequence = ++sequence_;
    m.request_at = m.reply_at = from_ns<ExecTime>(thread.asks_at);
    m.st_at_arrival = from_ns<SimTime>(st_);
    m.lag = Duration(thread.asks_at - st_);
    m.wall_at_arrival = tick();
    if (sequence_ == static_cast<std::uint64_t>(options_.interactions)) {
      m.kind = record::kFinish;
    } else {
      plan(m, thread.asks_at);
    }
    thread.open = m;
    advance(st_);
  }

  void plan(Interaction& m, std::int64_t t) {
    switch (random_.bits() % 6) {
      case 0:
      case 1:
        m.kind = record::kCommand;
        m.effect_at = from_ns<SimTime>(ceil_ns(t + 1'700'000, kStep_ns));
        m.grid_error = *m.effect_at - from_ns<SimTime>(t + 1'700'000);
        effects_.emplace(to_ns(*m.effect_at), m.sequence);
        break;
      case 2:
        m.kind = record::kSleep;
        m.sleep_until = from_ns<ExecTime>(t + below(30'000'000));
        m.reply_at = *m.sleep_until;
        break;
      case 3:
        m.kind = record::kSensor;
        m.sensor = "range";
        m.sample_index = range_index_++;
        set_sample(m, t, t + below(kMostRangeDelay_ns), kStep_ns);
        break;
      default:
        camera(m, t);
    }
  }

  void camera(Interaction& m, std::int64_t t) {
    m.kind = record::kSensor;
    m.sensor = "camera";
    m.latest = random_.bits() % 4 == 0;
    m.only_if_available = random_.bits() % 2 == 0;
    const std::int64_t there = t < kPhase + kDelay ? -1 : (t - kPhase - kDelay) / kPeriod_ns;
    const bool found = there >= (m.latest ? 0 : unread_);
    if (!found && m.only_if_available) return;
    const std::int64_t index = found ? there : unread_;
    m.sample_index = static_cast<std::uint64_t>(index);
    unread_ = std::max(unread_, index + 1);
    set_sample(m, kPhase + index * kPeriod_ns, kPhase + index * kPeriod_ns + kDelay, kStep_ns);
  }

  void log_stop() {
    drift(et_);
    record::Stop stop{"a", from_ns<ExecTime>(et_), std::nullopt, tick()};
    for (const Thread& t : threads_)
      if (t.open && reply_of(t) <= et_)
        stop.reply_at = std::min(stop.reply_at.value_or(t.open->reply_at), t.open->reply_at);
    record_.stops.push_back({from_ns<SimTime>(st_), order_++, stop});
  }

  void release_due() {
    std::vector<Thread*> due;
    for (Thread& t : threads_)
      if (t.open && reply_of(t) <= et_) due.push_back(&t);
    std::ranges::sort(
        due, {}, [](const Thread* t) { return std::pair(t->open->reply_at, t->open->sequence); });
    for (Thread* t : due) {
      if (!finished_) release(*t);
    }
  }

  void release(Thread& thread) {
    Interaction m = *thread.open;
    thread.open.reset();
    thread.asks_at = compute(et_);
    advance(floor_ns(to_ns(m.reply_at), kStep_ns));
    m.st_at_release = from_ns<SimTime>(st_);
    m.grid_error = std::max(m.grid_error, Duration(to_ns(m.reply_at) - st_));
    m.wall_at_release = tick();
    finished_ = m.kind == record::kFinish;
    record_.interactions.push_back({m.st_at_release, order_++, m});
  }

  WallTime tick() { return from_ns<WallTime>(wall_ += 1000); }

  void make_footer() {
    record::Footer footer;
    footer.end = "finished";
    footer.st_at_end = from_ns<SimTime>(st_);
    footer.et_at_end = {from_ns<ExecTime>(et_)};
    record_.footer = footer;
    set_figures(record_);
  }

  const ConcurrentOptions& options_;
  KeyedRandom random_;
  Record record_;
  std::vector<Thread> threads_;
  std::multimap<std::int64_t, std::uint64_t> effects_;  // ST → sequence
  std::int64_t et_ = 0;
  std::int64_t st_ = 0;
  std::int64_t wall_ = 1'000'000'000;
  std::int64_t unread_ = 0;
  std::uint64_t range_index_ = 0;
  std::uint64_t sequence_ = 0;
  std::uint64_t order_ = 0;
  bool finished_ = false;
};

}  // namespace

Record generate_concurrent(const ConcurrentOptions& options) {
  return ConcurrentHost(options).run();
}

}  // namespace tether::audit

#include "coordinator_fixture.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>

// SUTs that share the cores of boards and send each other messages: a message ends the wait of a
// `receive` on the time line of its board, and changes when others have done their work.
namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr Duration kStep = nanoseconds(500);
constexpr Duration kRangeDelay = nanoseconds(730);

/// When a request was made, and when the SUT went on.
struct TimedCall {
  std::int64_t request = 0, reply = 0;
  friend bool operator==(const TimedCall&, const TimedCall&) = default;
  friend std::ostream& operator<<(std::ostream& out, const TimedCall& call) {
    return out << call.request << " to " << call.reply;
  }
};

/// What a fleet does, and on which cores.
struct Fleet {
  struct Pool {
    std::int64_t cores = 1;
    std::vector<std::size_t> uavs;
  };
  std::vector<Script> scripts;
  std::vector<std::optional<std::size_t>> boards;  // by UAV
  std::vector<std::optional<int>> pins;
  std::vector<Pool> pools;
  Duration delay{0};
};

/// The same flight nanosecond by nanosecond, with nothing of the coordinator's: no bounds, no
/// steps, no order of messages. Shares are in parts of 1/60 (at most 6 SUTs).
class NaiveFlight {
 public:
  explicit NaiveFlight(const Fleet& fleet) : fleet_(fleet), suts_(fleet.scripts.size()) {}

  /// None: two events were at one instant, of which the order of UAVs decides.
  std::optional<std::vector<std::vector<TimedCall>>> run() {
    while (!is_over()) {
      while (act()) {
      }
      compute();
      ++now_;
    }
    if (is_tie_) return std::nullopt;
    std::vector<std::vector<TimedCall>> calls;
    for (Sut& sut : suts_) calls.push_back(std::move(sut.calls));
    return calls;
  }

 private:
  struct Sut {
    std::size_t next = 0;  // of its script
    bool is_computing = true, receives = false;
    std::int64_t resumed = 0, until = 0, computed = 0;
    std::deque<std::int64_t> inbox;  // arrivals
    std::vector<TimedCall> calls;
  };
  struct Arrival {
    std::int64_t at = 0;
    std::size_t to = 0;
  };

  bool is_over() const {
    for (std::size_t i = 0; i < suts_.size(); ++i)
      if (suts_[i].next < fleet_.scripts[i].size()) return false;
    return true;
  }

  void compute() {
    for (const Fleet::Pool& pool : fleet_.pools) {
      std::int64_t computing = 0;
      for (const std::size_t i : pool.uavs) computing += computes(i) ? 1 : 0;
      for (const std::size_t i : pool.uavs)
        if (computes(i))
          suts_[i].computed += computing > pool.cores ? 60 * pool.cores / computing : 60;
    }
  }
  bool computes(std::size_t i) const {
    return suts_[i].is_computing && suts_[i].next < fleet_.scripts[i].size();
  }

  // Whether anything happened now.
  bool act() {
    for (std::size_t k = 0; k < arrivals_.size(); ++k) {
      if (arrivals_[k].at != now_) continue;
      const std::size_t to = arrivals_[k].to;
      arrivals_.erase(arrivals_.begin() + static_cast<std::ptrdiff_t>(k));
      arrive(suts_[to]);
      return true;
    }
    for (std::size_t i = 0; i < suts_.size(); ++i) {
      Sut& sut = suts_[i];
      if (sut.next == fleet_.scripts[i].size()) continue;
      const Act& own = fleet_.scripts[i][sut.next];
      if (!sut.is_computing && sut.until <= now_) {
        go_on(sut);
        return true;
      }
      if (!sut.is_computing || sut.computed < 60 * own.compute.count()) continue;
      request(i, own);
      return true;
    }
    return false;
  }

  void go_on(Sut& sut) {
    sut.calls.back().reply = now_;
    sut.is_computing = true;
    sut.receives = false;
    sut.resumed = now_;
    sut.computed = 0;
    ++sut.next;
  }

  void arrive(Sut& sut) {
    is_tie_ = is_tie_ || (!sut.inbox.empty() && sut.inbox.back() == now_) ||
              (!sut.calls.empty() && (sut.calls.back().request == now_ ||
                                      sut.calls.back().reply == now_ || sut.until == now_));
    if (!sut.is_computing && sut.receives) return go_on(sut);
    sut.inbox.push_back(now_);
  }

  void request(std::size_t i, const Act& act) {
    Sut& sut = suts_[i];
    sut.is_computing = false;
    sut.calls.push_back({now_, 0});
    sut.until = now_;
    if (const auto* duration = std::get_if<Duration>(&act.what))
      sut.until = std::max(now_, sut.resumed + act.compute.count() + duration->count());
    if (std::holds_alternative<link::ReadSensor>(act.what)) sut.until += kRangeDelay.count();
    if (std::holds_alternative<link::SendMessage>(act.what))
      for (std::size_t to = 0; to < suts_.size(); ++to)
        if (to != i) arrivals_.push_back({now_ + fleet_.delay.count(), to});
    const auto* receive = std::get_if<link::ReceiveMessage>(&act.what);
    if (!receive) return;
    if (!sut.inbox.empty()) {
      is_tie_ = is_tie_ || sut.inbox.front() == now_;
      sut.inbox.pop_front();
      return;
    }
    sut.receives = true;
    sut.until += receive->timeout.count();
  }

  const Fleet& fleet_;
  std::vector<Sut> suts_;
  std::vector<Arrival> arrivals_;
  std::int64_t now_ = 0;
  bool is_tie_ = false;
};

Fleet draw_fleet(KeyedRandom& random) {
  Fleet fleet;
  const std::size_t uavs = 3 + random.bits() % 4;
  fleet.delay = nanoseconds(random.bits() % 3 == 0 ? 0 : random.bits() % 1200);
  const auto time = [&](std::uint32_t most) { return nanoseconds(1 + random.bits() % most); };
  const bool has_pins = random.bits() % 2 == 0;
  std::vector<Fleet::Pool> pools(4);  // board 0: free, pinned; board 1; alone
  pools[0].cores = 1 + random.bits() % 2;
  for (std::size_t i = 0; i < uavs; ++i) {
    const std::uint32_t where = random.bits() % 6;
    const bool is_pinned = has_pins && where == 1;
    const std::size_t pool = is_pinned ? 1 : where < 4 ? 0 : where == 4 ? 2 : 3;
    if (pool == 3) fleet.pools.push_back({1, {i}});
    pools[pool].uavs.push_back(i);
    fleet.boards.push_back(pool == 3 ? std::nullopt : std::optional(pool / 2));
    fleet.pins.push_back(is_pinned ? std::optional(2) : std::nullopt);
    Script script;
    for (std::size_t act = 0; act < 4 + random.bits() % 12; ++act) {
      const Duration work = random.bits() % 6 == 0 ? Duration(0) : Duration(time(900));
      const std::uint32_t what = random.bits() % 8;
      if (what == 0) script.push_back(turn(work, 0.1));
      if (what == 1) script.push_back(read(work, kRange));
      if (what == 2) script.push_back(sleep(work, time(2000)));
      if (what == 3 || what == 4) script.push_back(send(work));
      if (what >= 5) script.push_back(receive(work, time(what == 5 ? 300 : 6000)));
    }
    script.push_back(finish(time(500)));
    fleet.scripts.push_back(std::move(script));
  }
  pools.pop_back();
  for (const Fleet::Pool& pool : pools)
    if (!pool.uavs.empty()) fleet.pools.push_back(pool);
  return fleet;
}

class SharedRadio : public CoordinatorTest {
 protected:
  void make_fleet(const Fleet& fleet) {
    std::int64_t free_cores = 1;
    for (const Fleet::Pool& pool : fleet.pools) free_cores = std::max(free_cores, pool.cores);
    const bool has_pins =
        std::ranges::any_of(fleet.pins, [](const auto& pin) { return pin.has_value(); });
    options_.boards = {
        {"first", has_pins ? static_cast<int>(free_cores) + 1 : static_cast<int>(free_cores)},
        {"second", 1}};
    options_.radio.delay = fleet.delay;
    make(fleet.scripts.size(), kStep);
    for (std::size_t i = 0; i < fleet.scripts.size(); ++i) {
      UavOptions& uav = options_.uavs[i];
      uav.board = fleet.boards[i];
      if (fleet.pins[i]) uav.pinned_core = static_cast<int>(free_cores);
      uav.clock = computer::Clock{.kind = computer::ClockKind::kScripted};
      uav.timings[kRange] = uav::OnDemandTiming{uav::ConstantDelay{kRangeDelay}};
    }
    remake();
    for (std::size_t i = 0; i < fleet.scripts.size(); ++i)
      server_->add_sut(hello(name_of(i)), fleet.scripts[i]);
  }
  std::vector<TimedCall> calls_of(std::size_t uav) const {
    std::vector<TimedCall> calls;
    for (const record::Interaction& entry : recorder_.interactions)
      if (entry.uav == name_of(uav))
        calls.push_back({to_ns(entry.request_at), to_ns(entry.reply_at)});
    return calls;
  }
};

TEST_F(SharedRadio, AReceiveGoesOnWhenItsMessageArrivesAndTakesItsShareFromThen) {
  Fleet fleet;
  fleet.scripts = {{receive(nanoseconds(100), milliseconds(10)), finish(nanoseconds(600))},
                   {finish(nanoseconds(5'000))},
                   {send(nanoseconds(2'000)), finish(nanoseconds(10'000))}};
  fleet.boards = {0, 0, std::nullopt};
  fleet.pins.resize(3);
  fleet.pools = {{1, {0, 1}}, {1, {2}}};
  for (const bool is_late : {false, true}) {
    make_fleet(fleet);
    server_->choose = [&](std::size_t waiting) { return is_late ? waiting - 1 : 0; };
    const RunReport report = run();
    ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
    EXPECT_EQ(calls_of(0)[0], (TimedCall{200, 2'000}));
    EXPECT_EQ(calls_of(0)[1].request, 3'200) << "600 ns on half a core";
    EXPECT_EQ(calls_of(1)[0].request, 5'700) << "half a core until 200, and from 2,000 to 3,200";
  }
}

// Resumptions by own arithmetic, in any order of messages, and the same record.
TEST_F(SharedRadio, ResumesWhereANaiveFlightDoesInAnyOrderOfMessages) {
  int flown = 0, woken = 0;
  for (std::uint64_t seed = 0; seed < 250; ++seed) {
    KeyedRandom random({.seed = seed});
    const Fleet fleet = draw_fleet(random);
    const auto expected = NaiveFlight(fleet).run();
    if (!expected) continue;
    ++flown;
    std::string first;
    for (std::uint64_t order = 0; order < 3; ++order) {
      make_fleet(fleet);
      KeyedRandom choice({.seed = seed, .index = order});
      server_->choose = [&](std::size_t waiting) { return choice.bits() % waiting; };
      const RunReport report = run();
      ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason << ", seed " << seed;
      EXPECT_EQ(recorder_.footer->causality_violations, 0u);
      for (std::size_t i = 0; i < fleet.scripts.size(); ++i)
        ASSERT_EQ(calls_of(i), (*expected)[i]) << "seed " << seed << ", UAV " << i;
      for (const record::Interaction& entry : recorder_.interactions) {
        woken += entry.received && entry.reply_at > entry.request_at ? 1 : 0;
        EXPECT_EQ(entry.st_at_release, simulator_->grid().floor(same_instant(entry.reply_at)));
        EXPECT_LE(entry.st_at_arrival, simulator_->grid().floor(same_instant(entry.request_at)));
      }
      const std::string text = without_wall(recorder_);
      if (order == 0) first = text;
      ASSERT_EQ(text, first) << "seed " << seed << ", order " << order;
    }
  }
  EXPECT_GT(flown, 100);
  EXPECT_GT(woken, 500);
}

}  // namespace
}  // namespace tether::coordinator

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sync/shared_cores.h>

namespace tether::sync {
namespace {

ExecTime at_ns(std::int64_t ns) {
  return from_ns<ExecTime>(ns);
}

TEST(SharedCores, EqualProgramsTakeAsManyTimesAsLongAsThereAreTooFewCores) {
  for (const std::int64_t work :
       {std::int64_t{1}, std::int64_t{7}, std::int64_t{1'000'003}, std::int64_t{1} << 55})
    for (int cores = 1; cores <= 5; ++cores)
      for (std::size_t n = 1; n <= SharedCores::kMostPrograms; ++n) {
        SharedCores shared(cores, n);
        for (std::size_t i = 0; i < n; ++i) shared.ask(i, Duration(work));
        const auto programs = static_cast<std::int64_t>(n);
        __extension__ using Wide = __int128;
        const auto stretched =
            static_cast<std::int64_t>((Wide{work} * programs + cores - 1) / cores);
        for (std::size_t i = 0; i < n; ++i) {
          const auto stamp = shared.next();
          ASSERT_TRUE(stamp);
          EXPECT_EQ(stamp->program, i);
          ASSERT_EQ(stamp->at, at_ns(std::max(work, stretched))) << cores << " cores, " << n;
          shared.leave(i);
        }
      }
}

TEST(SharedCores, KnowsNoTimeBeyondUnknownWork) {
  SharedCores shared(1, 2);
  shared.ask(0, Duration(10));
  EXPECT_FALSE(shared.next());
  EXPECT_EQ(shared.bound(0), at_ns(10)) << "alone at best";
  EXPECT_EQ(shared.bound(1), at_ns(0));
  shared.progress(1, Duration(4));
  EXPECT_FALSE(shared.next());
  EXPECT_EQ(shared.bound(0), at_ns(8 + 6)) << "both have computed 4 until 8";
  EXPECT_EQ(shared.bound(1), at_ns(8));
  shared.ask(1, Duration(5));
  const auto first = shared.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->program, 1u);
  EXPECT_EQ(first->at, at_ns(10));
  shared.resume(1, at_ns(12));
  EXPECT_FALSE(shared.next());
  EXPECT_EQ(shared.bound(0), at_ns(12 + 3)) << "it had the core for itself until the other resumes";
}

TEST(SharedCores, AMarkOnTheWayChangesNothing) {
  for (const bool is_marked : {false, true}) {
    SharedCores shared(2, 3);
    shared.ask(0, Duration(is_marked ? 2 : 7));
    shared.ask(1, Duration(100));
    shared.ask(2, Duration(100));
    if (is_marked) {
      EXPECT_EQ(shared.next()->at, at_ns(3));
      shared.go_on(0);
      shared.ask(0, Duration(7));
    }
    EXPECT_EQ(shared.next()->at, at_ns(11)) << "7 · 3/2, rounded up";
  }
}

// What a program does: each phase computes `work`, then waits `pause`.
struct Phase {
  std::int64_t work = 0, pause = 0;
};
using Load = std::vector<std::vector<Phase>>;

// When each phase's work is done, nanosecond by nanosecond, in parts of 1/60 (at most 6 programs).
std::vector<std::vector<std::int64_t>> naive_ends(const Load& load, std::int64_t cores) {
  struct State {
    std::size_t phase = 0;
    std::int64_t resumes_at = 0, computed = 0;
  };
  std::vector<State> states(load.size());
  std::vector<std::vector<std::int64_t>> ends(load.size());
  for (std::int64_t now = 0;; ++now) {
    std::vector<std::size_t> computing;
    bool is_over = true;
    for (std::size_t i = 0; i < load.size(); ++i) {
      State& s = states[i];
      while (s.phase < load[i].size() && s.resumes_at <= now &&
             s.computed >= 60 * load[i][s.phase].work) {
        ends[i].push_back(now);
        s = {s.phase + 1, now + load[i][s.phase].pause, 0};
      }
      is_over = is_over && s.phase == load[i].size();
      if (s.phase < load[i].size() && s.resumes_at <= now) computing.push_back(i);
    }
    if (is_over) return ends;
    const auto n = static_cast<std::int64_t>(computing.size());
    for (const std::size_t i : computing) states[i].computed += n > cores ? 60 * cores / n : 60;
  }
}

// The programs' messages in a random order, with progress in between.
std::vector<std::vector<std::int64_t>> shared_ends(const Load& load, int cores,
                                                   KeyedRandom random) {
  SharedCores shared(cores, load.size());
  std::vector<std::vector<std::int64_t>> ends(load.size());
  std::vector<bool> asked(load.size());
  std::vector<ExecTime> bounds(load.size());
  for (std::size_t left = load.size(); left > 0;) {
    const std::size_t i = random.bits() % load.size();
    if (ends[i].size() < load[i].size() && !asked[i]) {
      const std::int64_t work = load[i][ends[i].size()].work;
      if (random.bits() % 3 == 0) {
        shared.progress(i, Duration(random.bits() % (work + 1)));
      } else {
        shared.ask(i, Duration(work));
        asked[i] = true;
      }
    }
    while (const auto stamp = shared.next()) {
      auto& own = ends[stamp->program];
      EXPECT_GE(stamp->at, bounds[stamp->program]) << "before its bound";
      own.push_back(to_ns(stamp->at));
      asked[stamp->program] = false;
      const Phase& phase = load[stamp->program][own.size() - 1];
      const bool is_last = own.size() == load[stamp->program].size();
      if (is_last) {
        shared.leave(stamp->program);
        --left;
      } else {
        shared.resume(stamp->program, stamp->at + Duration(phase.pause));
      }
    }
    for (std::size_t j = 0; j < load.size(); ++j) {
      EXPECT_GE(shared.bound(j), bounds[j]) << "a bound sank";
      bounds[j] = shared.bound(j);
    }
  }
  return ends;
}

TEST(SharedCores, MixedLoadsAgreeWithANaiveSimulationInAnyOrderOfMessages) {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    KeyedRandom random({.seed = seed});
    Load load(1 + random.bits() % 6);
    for (auto& phases : load) {
      phases.resize(1 + random.bits() % 8);
      for (Phase& phase : phases)
        phase = {random.bits() % 4 == 0 ? 0 : random.bits() % 40,
                 random.bits() % 2 == 0 ? 0 : random.bits() % 30};
    }
    const int cores = 1 + static_cast<int>(random.bits() % 4);
    ASSERT_EQ(shared_ends(load, cores, random), naive_ends(load, cores)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace tether::sync

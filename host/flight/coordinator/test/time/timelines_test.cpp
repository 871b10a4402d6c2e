#include "time/timelines.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base/random.h>

// The time of SUTs in each of its cases, without a simulator or a link.
namespace tether::coordinator {
namespace {

using computer::ClockKind;
using std::chrono::microseconds;

constexpr StepGrid kGrid{std::chrono::milliseconds(1)};

ExecTime et_us(std::int64_t value) {
  return ExecTime(microseconds(value));
}

/// What a run consists of: SUTs with one clock, on one computer each or on one board.
struct TimeCase {
  std::string name{};
  ClockKind clock = ClockKind::kScripted;
  bool is_concurrent = false;
  bool is_free = false;
  std::optional<Board> board{};
  Timeline::Facts facts{};
};

const TimeCase kTimeCases[] = {
    {.name = "own", .facts = {true, true, true, true, false}},
    {.name = "own, by CPU time",
     .clock = ClockKind::kCpu,
     .facts = {true, true, false, true, false}},
    {.name = "unstamped",
     .clock = ClockKind::kUnstamped,
     .facts = {true, false, false, false, false}},
    {.name = "concurrent",
     .clock = ClockKind::kWall,
     .is_concurrent = true,
     .facts = {false, true, false, false, false}},
    {.name = "group of a real board",
     .clock = ClockKind::kWall,
     .is_concurrent = true,
     .board = Board{.name = "obc", .cores = 0, .is_real = true},
     .facts = {false, true, false, false, true}},
    {.name = "modelled board",
     .board = Board{.name = "obc", .cores = 2},
     .facts = {true, true, true, true, true}},
    {.name = "free running",
     .clock = ClockKind::kWall,
     .is_free = true,
     .facts = {true, false, false, false, false}},
};
constexpr std::size_t kSuts = 3, kMostOpen = 5;

class TimelinesTest : public testing::Test {
 protected:
  void make(const TimeCase& which, std::size_t suts = kSuts) {
    options_ = {};
    if (which.is_free) options_.policy = sync::SyncPolicy::kFreeRunning;
    options_.real_time_factor = which.is_free ? 1.0 : 0.0;
    options_.uavs.resize(suts);
    if (which.board) options_.boards = {*which.board};
    for (UavOptions& uav : options_.uavs) {
      uav.clock = computer::Clock{.kind = which.clock};
      if (which.board) uav.board = 0;
    }
    begin(which.is_concurrent);
  }
  void begin(bool is_concurrent = false) {
    times_ = std::make_unique<Timelines>(options_, kGrid);
    for (std::size_t uav = 0; uav < options_.uavs.size(); ++uav) {
      link::Hello hello;
      hello.clock = *options_.uavs[uav].clock;
      hello.concurrent = is_concurrent;
      times_->begin(uav, hello, 4, WallTime{});
    }
    planned_.assign(options_.uavs.size(), {});
    calls_.assign(options_.uavs.size(), 0);
    st_ = {};
  }
  Timeline& time(std::size_t uav) { return (*times_)[uav]; }

  /// The SUT has computed for `work` since its last reply, or a concurrent one since its bound, and
  /// calls for `delay`.
  void call(std::size_t uav, Duration work, Duration delay) {
    link::Request request;
    request.sequence = ++calls_[uav];
    request.issued_at =
        (time(uav).facts().is_serial ? time(uav).resumed_at() : time(uav).bound()) + work;
    const WallTime wall = WallTime{} + request.issued_at.time_since_epoch();
    delays_[{uav, request.sequence}] = delay;
    if (auto sent = time(uav).send({request, st_, wall, uav})) plan(*sent);
    settle();
  }
  /// A concurrent SUT stops when the first of its replies is due.
  void stop(std::size_t uav) {
    const auto& open = planned_[uav];
    const auto first = std::ranges::min_element(open, {}, &record::Interaction::reply_at);
    if (first != open.end())
      time(uav).progress({.reached = std::max(time(uav).bound(), first->reply_at),
                          .stopped = true,
                          .dues_heard = calls_[uav]});
  }
  void settle() {
    while (times_->settle([] { return std::nullopt; },
                          [](std::size_t, ExecTime, ExecTime, double) {},
                          [this](const Sent& sent) { plan(sent); }))
      continue;
  }
  void plan(const Sent& sent) {
    const auto& request = std::get<link::Request>(sent.message);
    record::Interaction entry;
    entry.sequence = request.sequence;
    entry.wall_at_arrival = sent.wall;
    entry.request_at = time(sent.uav).arrive(sent).charged_at;
    entry.reply_at = entry.request_at + delays_[{sent.uav, request.sequence}];
    EXPECT_GE(entry.request_at, time(sent.uav).resumed_at());
    due_ = time(sent.uav).hold(entry);
    planned_[sent.uav].push_back(entry);
  }
  /// Sends what can be sent; how many replies.
  int release() {
    int released = 0;
    while (const auto grant = times_->release(st_, {})) {
      auto& open = planned_[grant->sut];
      const auto entry = std::ranges::find(open, grant->call, &record::Interaction::sequence);
      EXPECT_EQ(grant->released_at, st_);
      if (time(grant->sut).et()) {
        EXPECT_EQ(grant->resume_at, entry->reply_at);
        EXPECT_EQ(kGrid.floor(same_instant(grant->resume_at)), st_);
      }
      entry->reply_at = grant->resume_at;
      entry->wall_at_release = entry->wall_at_arrival;
      time(grant->sut).replied(*entry);
      EXPECT_EQ(time(grant->sut).resumed_at(), grant->resume_at);
      open.erase(entry);
      ++released;
      settle();
    }
    return released;
  }

  RunOptions options_;
  std::unique_ptr<Timelines> times_;
  std::vector<std::vector<record::Interaction>> planned_;  // open calls, by UAV
  std::vector<std::uint64_t> calls_;
  std::map<std::pair<std::size_t, std::uint64_t>, Duration> delays_;  // by UAV and call
  std::optional<link::Due> due_;
  SimTime st_{};
};

TEST_F(TimelinesTest, TheCaseFollowsFromThePolicyTheSutItsBoardAndItsClock) {
  for (const TimeCase& which : kTimeCases) {
    make(which);
    const auto& [serial, stamped, repeats, unseen, shares] = time(1).facts();
    EXPECT_EQ(serial, which.facts.is_serial) << which.name;
    EXPECT_EQ(stamped, which.facts.is_stamped) << which.name;
    EXPECT_EQ(repeats, which.facts.repeats) << which.name;
    EXPECT_EQ(unseen, which.facts.may_wait_unseen) << which.name;
    EXPECT_EQ(shares, which.facts.shares_board) << which.name;
    EXPECT_EQ(time(1).et().has_value(), !which.is_free) << which.name;
    EXPECT_TRUE(time(1).is_computing()) << which.name;
  }
}

TEST_F(TimelinesTest, BeforeItHasBegunASutHasNoTime) {
  options_.uavs.resize(1);
  times_ = std::make_unique<Timelines>(options_, kGrid);
  EXPECT_FALSE(time(0).is_computing());
  EXPECT_FALSE(time(0).is_held());
  EXPECT_FALSE(time(0).et());
  EXPECT_EQ(times_->limit(), SimTime::max());
  EXPECT_FALSE(times_->earliest());
}

// ST never passes the limit, a bound never falls, and every call is answered, whatever the SUT is.
TEST_F(TimelinesTest, EveryCallIsAnsweredAtItsTimeInEachCase) {
  for (const TimeCase& which : kTimeCases) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      KeyedRandom random({.seed = seed});
      make(which);
      std::vector<ExecTime> bounds(kSuts);
      int calls = 0, answered = 0;
      while (answered < 200) {
        std::vector<std::size_t> computing;
        for (std::size_t uav = 0; uav < kSuts; ++uav)
          if (time(uav).is_computing() && planned_[uav].size() < kMostOpen)
            computing.push_back(uav);
        if (!computing.empty() && random.bits() % 4 != 0) {
          call(computing[random.bits() % computing.size()], microseconds(random.bits() % 3000),
               microseconds(random.bits() % 3000));
          ++calls;
        } else {
          for (std::size_t uav = 0; which.is_concurrent && uav < kSuts; ++uav) stop(uav);
          const SimTime limit = times_->limit();
          ASSERT_TRUE(which.is_free || st_ <= limit) << which.name << ", seed " << seed;
          if (limit != SimTime::max()) st_ = std::max(st_, limit);
        }
        answered += release();
        for (std::size_t uav = 0; uav < kSuts; ++uav)
          ASSERT_GE(time(uav).bound(), std::exchange(bounds[uav], time(uav).bound()));
        ASSERT_LE(calls - answered, static_cast<int>(kSuts * kMostOpen));
      }
    }
  }
}

// Alone on its core of a modelled board, a SUT has the time that it has on a computer of its own.
TEST_F(TimelinesTest, AModelledCoreForOneSutChangesNothing) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::vector<std::pair<ExecTime, ExecTime>> flights[2];
    for (const bool is_on_board : {false, true}) {
      make(is_on_board ? TimeCase{.board = Board{.name = "obc", .cores = 2}} : TimeCase{});
      for (std::size_t uav = 0; is_on_board && uav < kSuts; ++uav)
        options_.uavs[uav].pinned_core = uav == 0 ? 0 : 1;
      begin();
      ASSERT_EQ(time(0).facts().shares_board, is_on_board);
      for (const std::size_t other : {1u, 2u}) time(other).leave();
      KeyedRandom random({.seed = seed});
      for (int i = 0; i < 100; ++i) {
        call(0, microseconds(random.bits() % 3000), microseconds(random.bits() % 3000));
        ASSERT_EQ(planned_[0].size(), 1u);
        flights[is_on_board].emplace_back(planned_[0][0].request_at, planned_[0][0].reply_at);
        st_ = times_->limit();
        ASSERT_EQ(release(), 1);
      }
    }
    EXPECT_EQ(flights[0], flights[1]);
  }
}

TEST_F(TimelinesTest, WhatASutStampsBeforeItsOwnProgressIsAViolationInEachCase) {
  for (const TimeCase& which : kTimeCases) {
    make(which);
    if (!time(0).facts().is_stamped || which.is_concurrent) continue;
    for (std::size_t other = 1; other < kSuts; ++other) time(other).leave();
    EXPECT_FALSE(time(0).progress({.reached = et_us(900)}));
    EXPECT_EQ(time(0).last_stamp(), et_us(900)) << which.name;
    link::Request request;
    request.issued_at = et_us(700);
    std::optional<sync::Arrival> arrival;
    const auto arrive = [&](const Sent& sent) {
      arrival = time(0).arrive(sent);
      record::Interaction entry;
      entry.reply_at = arrival->charged_at;
      time(0).hold(entry);
    };
    if (auto sent = time(0).send({request, st_, WallTime{}, 0})) arrive(*sent);
    if (!arrival)
      times_->settle([] { return std::nullopt; }, [](std::size_t, ExecTime, ExecTime, double) {},
                     arrive);
    ASSERT_TRUE(arrival && arrival->violation) << which.name;
    EXPECT_EQ(arrival->violation->size, microseconds(200)) << which.name;
    EXPECT_EQ(arrival->charged_at, et_us(900)) << which.name;
  }
}

TEST_F(TimelinesTest, AConcurrentSutKnowsEachReplysTimeAndStopsForIt) {
  make(kTimeCases[3], 1);
  call(0, microseconds(500), microseconds(2500));
  ASSERT_TRUE(due_);
  EXPECT_EQ(due_->reply_at, et_us(3000));
  EXPECT_TRUE(time(0).is_computing());
  const auto moved = time(0).move_up(1, et_us(2000));
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->reply_at, et_us(2000));
  EXPECT_FALSE(time(0).move_up(1, et_us(2000))) << "the same time again";
  planned_[0][0].reply_at = et_us(2000);
  st_ = times_->limit();
  EXPECT_EQ(st_, SimTime{}) << "of its bound";
  auto stop = time(0).progress({.reached = et_us(2100), .stopped = true, .dues_heard = 1});
  ASSERT_TRUE(stop);
  EXPECT_FALSE(stop->due) << "it had not heard of that time";
  EXPECT_EQ(times_->limit(), st_ = SimTime(microseconds(2000)));
  EXPECT_EQ(release(), 0);
  EXPECT_FALSE(time(0).progress({.reached = et_us(2100), .stopped = true, .dues_heard = 2}))
      << "the same stop is reported once";
  EXPECT_TRUE(time(0).is_held());
  EXPECT_EQ(release(), 1);
}

TEST_F(TimelinesTest, InFreeRunningOnlyWhatWaitsIsHeld) {
  make(kTimeCases[6]);
  call(0, microseconds(100), microseconds(2500));
  call(1, microseconds(100), microseconds(0));
  EXPECT_EQ(release(), 1) << "that of UAV 1";
  EXPECT_EQ(times_->limit(), SimTime(microseconds(3000))) << "at the end of its step";
  EXPECT_FALSE(time(0).is_computing());
  call(2, microseconds(100), microseconds(9000));
  EXPECT_FALSE(time(0).move_up(1, et_us(0))) << "a message has arrived";
  EXPECT_EQ(release(), 1);
  EXPECT_TRUE(time(0).is_computing());
  time(2).leave();
  EXPECT_EQ(times_->limit(), SimTime::max());
}

TEST_F(TimelinesTest, OnlyAConcurrentSutCanBeInAGroup) {
  link::Hello serial, concurrent;
  concurrent.concurrent = true;
  make(kTimeCases[4]);
  EXPECT_TRUE(times_->fault_of(1, serial));
  EXPECT_FALSE(times_->fault_of(1, concurrent));
  make(kTimeCases[5]);
  EXPECT_FALSE(times_->fault_of(1, serial));
}

TEST_F(TimelinesTest, RefusesOptionsThatCannotBe) {
  make(kTimeCases[6]);
  options_.real_time_factor = 0.0;
  EXPECT_THROW(Timelines(options_, kGrid), Error) << "no pace";

  make({.board = Board{.name = "obc", .cores = 1}});
  options_.uavs[0].pinned_core = 1;
  EXPECT_THROW(Timelines(options_, kGrid), Error) << "no such core";
  options_.uavs[0].pinned_core = 0;
  EXPECT_THROW(Timelines(options_, kGrid), Error) << "no core is left for the others";
  options_.uavs[0].pinned_core.reset();
  options_.uavs[1].clock.reset();
  EXPECT_THROW(Timelines(options_, kGrid), Error) << "no clock";
}

}  // namespace
}  // namespace tether::coordinator

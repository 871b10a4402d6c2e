#include "controller_fixture.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/base_testing/sanitizer.h>

// Flight controllers and their companions: nothing comes from the future, is lost, comes twice or
// out of order, on any schedule.
namespace tether::coordinator {
namespace {

struct Interleaving {
  std::size_t uavs = 1;
  Duration period, latency;
  double baud = 0.0;
  std::size_t size = 8;
  bool is_shared = false, is_concurrent = false, is_free = false;
  std::vector<std::vector<Script>> scripts;  // of each UAV: its threads
};

/// `acts`: of each thread, at most.
Interleaving draw(std::uint64_t seed, int acts) {
  KeyedRandom random({.seed = seed});
  Interleaving run;
  run.uavs = 1 + random.bits() % 4;
  run.period = milliseconds(1 + random.bits() % 5);
  run.latency = random.bits() % 2 ? Duration(0) : microseconds(random.bits() % 9'000);
  run.baud = random.bits() % 2 ? 0.0 : 921'600.0;
  run.size = 8 + random.bits() % 32;
  const std::uint32_t kind = random.bits() % 4;
  run.is_shared = kind == 1;
  run.is_concurrent = kind == 2;
  run.is_free = kind == 3 && random.bits() % 2;
  for (std::size_t uav = 0; uav < run.uavs; ++uav) {
    std::vector<Script> threads(run.is_concurrent && uav == 0 ? 2 : 1);
    std::uint64_t number = 0;
    for (Script& script : threads) {
      for (int k = 0; k < acts; ++k) {
        const Duration compute = microseconds(10) * (random.bits() % 60);
        const std::uint32_t what = random.bits() % 8;
        if (what < 2) script.push_back(to_controller(compute, ++number, 8 + random.bits() % 40));
        if (what == 2) script.push_back(sleep(compute, microseconds(random.bits() % 3'000)));
        if (what == 3 && k % 20 == 0) script.push_back(read(compute, kRange));
        if (what >= 4)
          script.push_back(receive(compute, microseconds(random.bits() % 5'000),
                                   what == 7 ? 1 + random.bits() % 4 : 1));
      }
    }
    for (int k = 0; k < acts / 10; ++k) threads[0].push_back(receive({}, milliseconds(3)));
    threads[0].push_back(finish(milliseconds(20)));
    run.scripts.push_back(std::move(threads));
  }
  return run;
}

/// Rules, from what the companions and the controllers have seen.
class InterleavingTest : public ControllerLinksTest {
 protected:
  struct Sent {
    SimTime at;
    std::uint64_t number = 0;
    std::size_t bytes = 0;
  };

  std::string fly(const Interleaving& run, std::uint64_t schedule) {
    options_ = {};
    if (run.is_free) set_free_running(1.0);
    make_links(run.uavs, {.period = run.period,
                          .latency = run.latency,
                          .baud = run.baud,
                          .own = 1,
                          .size = run.size});
    if (run.is_shared) {
      options_.boards = {{"obc", 2}};
      for (UavOptions& uav : options_.uavs) {
        uav.board = 0;
        uav.clock = computer::Clock{.kind = computer::ClockKind::kScripted};
      }
      remake();
    }
    for (std::size_t i = 0; i < run.uavs; ++i) {
      if (run.scripts[i].size() == 1)
        server_->add_sut(hello(name_of(i)), run.scripts[i][0]);
      else
        server_->add_threads(hello(name_of(i)), run.scripts[i], microseconds(30));
    }
    KeyedRandom order({.seed = schedule, .stream = 1});
    server_->choose = [&](std::size_t waiting) { return order.bits() % waiting; };
    const RunReport report = this->run();
    EXPECT_EQ(report.end, RunEnd::kFinished) << report.reason;
    std::string text = without_wall(recorder_);
    for (const record::AutopilotMessage& m : recorder_.autopilot) {
      text += "\n" + m.uav + (m.to_controller ? " to " : " from ") + m.outcome;
      for (const std::uint64_t value : {m.sequence, m.bytes}) text += " " + std::to_string(value);
      for (const SimTime at : {m.sent_at, m.at, m.acted_at.value_or(SimTime{})})
        text += " " + std::to_string(to_ns(at));
    }
    return text;
  }

  SimTime next_step(SimTime at, Duration period) {
    const std::int64_t periods = (to_ns(at) + period.count() - 1) / period.count();
    return SimTime(periods * period);
  }
  // What the companion has sent, in the order of time; by its interactions.
  std::vector<Sent> sent_by(const Interleaving& run, std::size_t uav) {
    std::vector<Sent> sent;
    std::map<std::uint64_t, std::size_t> bytes;
    for (const Script& script : run.scripts[uav])
      for (const Act& act : script)
        if (const auto* message = std::get_if<link::SendMessage>(&act.what))
          bytes[number_of(message->bytes)] = message->bytes.size();
    std::vector<record::Interaction> calls;
    for (const record::Interaction& entry : recorder_.interactions)
      if (entry.uav == name_of(uav) && entry.kind == record::kSend) calls.push_back(entry);
    std::ranges::stable_sort(calls, {}, [](const record::Interaction& entry) {
      return std::pair(entry.request_at, entry.sequence);
    });
    for (const record::Interaction& entry : calls)
      sent.push_back({same_instant(entry.request_at), 0, 0});
    if (run.scripts[uav].size() == 1) {
      std::uint64_t number = 0;
      for (Sent& message : sent) {
        message.number = ++number;
        message.bytes = bytes[number];
      }
    }
    return sent;
  }

  void check_to_controller(const Interleaving& run, std::size_t uav) {
    const std::vector<Sent> sent = sent_by(run, uav);
    const std::vector<Taken>& taken = taken_[uav];
    const SimTime end = recorder_.footer->st_at_end;
    ASSERT_LE(taken.size(), sent.size()) << "none twice";
    SimTime free_at{};
    for (std::size_t i = 0; i < sent.size(); ++i) {
      ++messages_;
      const bool is_known = sent[i].number > 0;
      SimTime arrives_at = sent[i].at;
      if (run.baud > 0.0 && is_known) {
        free_at = std::max(free_at, sent[i].at) +
                  Duration(static_cast<std::int64_t>(
                      std::ceil(static_cast<double>(sent[i].bytes) * 1e10 / run.baud)));
        arrives_at = free_at;
      }
      arrives_at += run.latency;
      // Of messages of several threads, it is not known how long they are: at most 48 bytes.
      const Duration on_line = is_known ? Duration(0) : sent.size() * microseconds(521);
      if (i >= taken.size()) {
        EXPECT_GT(next_step(arrives_at + on_line, run.period), end - milliseconds(1))
            << "none lost";
        continue;
      }
      EXPECT_GE(taken[i].at, arrives_at) << "none from the future";
      // In free running, what is sent at the boundary of a step is sent after it.
      if (run.baud == 0.0 || is_known) {
        EXPECT_LE(taken[i].at, next_step(arrives_at + Duration(run.is_free ? 1 : 0), run.period));
      }
      if (is_known) {
        EXPECT_EQ(taken[i].number, sent[i].number) << "in order";
      }
    }
  }

  void check_to_companion(const Interleaving& run, std::size_t uav) {
    std::uint64_t own = 0, sequence = 0;
    std::size_t echoes = 0;
    std::vector<record::Interaction> calls;
    for (const record::Interaction& entry : recorder_.interactions)
      if (entry.uav == name_of(uav) && entry.received) calls.push_back(entry);
    std::ranges::sort(calls, {}, [](const auto& entry) { return entry.received->sequence; });
    for (const record::Interaction& entry : calls) {
      ++messages_;
      EXPECT_EQ(entry.received->sequence, ++sequence) << "none lost, none twice";
      sequence += entry.received_more;
      EXPECT_GE(same_instant(entry.reply_at), entry.received->arrived_at) << "from the future";
    }
    for (const link::Reply& reply : replies_to(static_cast<link::PeerId>(uav + 1))) {
      if (!reply.message) continue;
      std::vector<link::RadioMessage> messages = reply.more;
      messages.insert(messages.begin(), *reply.message);
      together_ += reply.more.size();
      for (const link::RadioMessage& message : messages) {
        EXPECT_EQ((to_ns(message.sent_at) - 1) % run.period.count(), 0);
        EXPECT_GE(message.arrived_at, message.sent_at + run.latency);
        if (run.baud == 0.0) {
          EXPECT_EQ(message.arrived_at, message.sent_at + run.latency);
        }
        EXPECT_GE(same_instant(reply.resume_at), message.arrived_at);
        const std::uint64_t number = number_of(message.bytes);
        if (number < kEcho) {
          if (run.scripts[uav].size() == 1) {
            EXPECT_EQ(number, ++own) << "in order";
          }
        } else {
          ASSERT_LT(echoes, taken_[uav].size());
          if (run.scripts[uav].size() == 1) {
            EXPECT_EQ(number - kEcho, taken_[uav][echoes].number) << "in order";
          }
          EXPECT_EQ(message.sent_at, taken_[uav][echoes].at + Duration(1))
              << "at the step that has taken it";
          ++echoes;
        }
      }
    }
  }

  void check(std::uint64_t seed, int acts) {
    const Interleaving run = draw(seed, acts);
    std::string first;
    for (std::uint64_t schedule = 1; schedule <= 2; ++schedule) {
      ++interleavings_;
      const std::string text = fly(run, schedule);
      EXPECT_EQ(
          std::ranges::count(recorder_.autopilot, "inbox_full", &record::AutopilotMessage::outcome),
          0);
      for (std::size_t uav = 0; uav < run.uavs; ++uav) {
        check_to_controller(run, uav);
        check_to_companion(run, uav);
      }
      if (!run.is_free) {
        EXPECT_EQ(recorder_.footer->causality_violations, 0U);
      }
      if (schedule == 1) first = text;
      if (!run.is_free && !run.is_concurrent) {
        ASSERT_EQ(text, first) << "the same record on each schedule";
      }
      ASSERT_FALSE(HasFailure()) << "seed " << seed << ", schedule " << schedule
                                 << (run.is_free ? ", free" : "")
                                 << (run.is_concurrent ? ", concurrent" : "")
                                 << (run.is_shared ? ", shared" : "");
    }
  }

  std::uint64_t messages_ = 0, together_ = 0, interleavings_ = 0;
};

// A sanitizer, which looks for other faults, is several times slower.
constexpr std::uint64_t kShare = TETHER_ADDRESS_SANITIZER || TETHER_THREAD_SANITIZER ? 5 : 1;

TEST_F(InterleavingTest, KeepTheRulesInLongRuns) {
  for (std::uint64_t seed = 1; messages_ < 100'000 / kShare && !HasFatalFailure(); ++seed)
    check(seed, 120);
  EXPECT_GT(together_, messages_ / 100);
}

TEST_F(InterleavingTest, KeepTheRulesInManyShortRuns) {
  for (std::uint64_t seed = 1; interleavings_ < 3'000 / kShare && !HasFatalFailure(); ++seed)
    check(seed, 10);
}

// Half a minute; by itself (CMakeLists.txt).
TEST_F(InterleavingTest, DISABLED_KeepTheRulesInAHundredThousandRuns) {
  for (std::uint64_t seed = 10'000; interleavings_ < 100'000 && !HasFatalFailure(); ++seed)
    check(seed, 10);
}

}  // namespace
}  // namespace tether::coordinator

#include "controller_links.h"

#include "coordinator_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include <tether/base/random.h>
#include <tether/base_testing/sanitizer.h>

// Flight controllers and their companions: nothing comes from the future, is lost, comes twice or
// out of order, on any schedule.
namespace tether::coordinator {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

autopilot::Bytes bytes_of(std::uint64_t number, std::size_t size = 8) {
  autopilot::Bytes bytes(std::max<std::size_t>(size, 8), 0);
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}
std::uint64_t number_of(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data(), std::min(bytes.size(), sizeof number));
  return number;
}

/// What a controller has taken, and when.
struct Taken {
  SimTime at;
  std::uint64_t number = 0;
};
constexpr std::uint64_t kEcho = std::uint64_t{1} << 32;

/// Sends back what it has taken, and so many numbers of its own at each step.
class Echo final : public autopilot::FlightController {
 public:
  Echo(std::vector<Taken>& taken, std::uint64_t own, std::size_t size)
      : taken_(&taken), own_(own), size_(size) {
    taken_->clear();
  }
  autopilot::Actions step(const autopilot::Sensed& sensed,
                          const std::vector<autopilot::Bytes>& received) override {
    autopilot::Actions actions;
    for (const autopilot::Bytes& bytes : received) {
      taken_->push_back({sensed.at, number_of(bytes)});
      actions.sent.push_back(bytes_of(kEcho + number_of(bytes), size_));
    }
    for (std::uint64_t i = 0; i < own_; ++i) actions.sent.push_back(bytes_of(++count_, size_));
    actions.setpoint = uav::Setpoint{.velocity_m_s = {static_cast<double>(taken_->size()), 0, 0}};
    return actions;
  }

 private:
  std::vector<Taken>* taken_;
  std::uint64_t own_, count_ = 0;
  std::size_t size_;
};

Act to_controller(Duration compute, std::uint64_t number, std::size_t size = 8) {
  return {compute, link::SendMessage{link::kAutopilot, bytes_of(number, size)}};
}

class ControllerLinksTest : public CoordinatorTest {
 protected:
  struct Link {
    Duration period = milliseconds(4);
    Duration latency{0};
    double baud = 0.0;
    std::uint64_t own = 1;
    std::size_t size = 8;  // of what the controller sends
  };
  void make_links(std::size_t uavs, const Link& link, std::size_t without = 0) {
    make(uavs + without);
    taken_.resize(uavs);
    for (std::size_t i = 0; i < uavs; ++i)
      options_.uavs[i].controller = ControllerOptions{
          .name = "echo",
          .estimate = "truth",
          .make = [this, i,
                   link] { return std::make_unique<Echo>(taken_[i], link.own, link.size); },
          .period = link.period,
          .link_baud = link.baud,
          .link_latency = link.latency};
    remake();
  }
  std::vector<std::uint64_t> numbers_taken(std::size_t uav) const {
    std::vector<std::uint64_t> numbers;
    for (const Taken& taken : taken_[uav]) numbers.push_back(taken.number);
    return numbers;
  }

  std::vector<std::vector<Taken>> taken_;
};

TEST(Line, TakesTenBitsForAByteAndHasRoomForASecond) {
  Line line(1'000.0, milliseconds(5));
  EXPECT_EQ(line.send(st_ms(0), 10), st_ms(105));
  EXPECT_EQ(line.send(st_ms(1), 10), st_ms(205)) << "after the first one";
  EXPECT_EQ(line.send(st_ms(500), 10), st_ms(605)) << "it was free";
  EXPECT_EQ(line.send(st_ms(500), 101), st_ms(1'615));
  EXPECT_EQ(line.send(st_ms(500), 1), std::nullopt) << "1.11 s are waiting";
  EXPECT_EQ(line.send(st_ms(610), 1), st_ms(1'625));
  EXPECT_EQ(Line(0.0, milliseconds(2)).send(st_ms(7), 1'000'000), st_ms(9));
}

/// Measures twice when it boots, and at each step.
class Measuring final : public autopilot::FlightController {
 public:
  explicit Measuring(std::vector<std::uint64_t>& indices) : indices_(&indices) {}
  void boot(const autopilot::Sensed& at_rest) override {
    EXPECT_EQ(at_rest.at, SimTime{});
    for (int i = 0; i < 2; ++i) measure(at_rest);
  }
  autopilot::Actions step(const autopilot::Sensed& sensed,
                          const std::vector<autopilot::Bytes>&) override {
    measure(sensed);
    return {};
  }

 private:
  void measure(const autopilot::Sensed& sensed) {
    const auto sample = sensed.measure(uav::SensorKind::kImu);
    indices_->push_back(std::visit([](const auto& content) { return content.index; }, *sample));
  }
  std::vector<std::uint64_t>* indices_;
};

TEST_F(ControllerLinksTest, AControllerBootsByItsSensorsEachTimeWithOtherNoise) {
  std::vector<std::uint64_t> indices;
  make_links(1, {});
  options_.uavs[0].controller->make = [&] { return std::make_unique<Measuring>(indices); };
  remake();
  ASSERT_EQ(indices.size(), 2U) << "before the flight";
  run({finish(milliseconds(9))});
  ASSERT_GE(indices.size(), 5U);
  const std::set<std::uint64_t> all(indices.begin(), indices.end());
  EXPECT_EQ(all.size(), indices.size());
}

TEST_F(ControllerLinksTest, AMessageActsAtTheFirstStepAfterItsArrival) {
  make_links(1, {});
  ASSERT_EQ(run({to_controller(microseconds(3'999), 1), to_controller(microseconds(1), 2),
                 to_controller(Duration(1), 3), finish(milliseconds(20))})
                .end,
            RunEnd::kFinished);
  ASSERT_EQ(numbers_taken(0), (std::vector<std::uint64_t>{1, 2, 3}));
  EXPECT_EQ(taken_[0][0].at, st_ms(4));
  EXPECT_EQ(taken_[0][1].at, st_ms(4)) << "sent at the boundary itself";
  EXPECT_EQ(taken_[0][2].at, st_ms(8));
}

TEST_F(ControllerLinksTest, ARoundTripIsAStepAndTheLatencies) {
  make_links(1, {.latency = microseconds(1'500), .own = 0});
  const RunReport report =
      run({to_controller(microseconds(2'500), 9), receive({}, milliseconds(50)), finish({})});
  ASSERT_EQ(report.end, RunEnd::kFinished) << report.reason;
  const link::Reply reply = replies_to(1).at(1);
  ASSERT_TRUE(reply.message);
  EXPECT_EQ(reply.message->from, link::kAutopilot);
  EXPECT_EQ(number_of(reply.message->bytes), kEcho + 9);
  EXPECT_EQ(reply.message->sent_at, st_ms(4) + Duration(1));
  EXPECT_EQ(reply.resume_at, us(5'500) + Duration(1));
}

TEST_F(ControllerLinksTest, WhatItFollowsHoldsFromItsStepOn) {
  make_links(1, {});
  run({to_controller(microseconds(4'100), 1), finish(milliseconds(20))});
  const auto first = std::ranges::find_if(simulator_->applied(), [](const auto& applied) {
    return applied.setpoint.velocity_m_s.x > 0.0;
  });
  ASSERT_NE(first, simulator_->applied().end());
  EXPECT_EQ(first->at, st_ms(8));
  EXPECT_TRUE(recorder_.commands.empty());
}

TEST_F(ControllerLinksTest, TheRecordHasEveryMessage) {
  make_links(1, {.latency = milliseconds(1)});
  run({to_controller(milliseconds(2), 1, 20), receive({}, milliseconds(9)),
       to_controller(milliseconds(9), 2), finish({})});
  std::size_t to = 0, from = 0;
  for (const record::AutopilotMessage& m : recorder_.autopilot) {
    EXPECT_EQ(m.uav, name_of(0));
    ++(m.to_controller ? to : from);
    if (m.to_controller && m.sequence == 1) {
      EXPECT_EQ(m.bytes, 20U);
      EXPECT_EQ(m.sent_at, st_ms(2));
      EXPECT_EQ(m.at, st_ms(3));
      EXPECT_EQ(m.acted_at, st_ms(4));
      EXPECT_EQ(m.outcome, record::kDelivered);
    }
    if (m.to_controller && m.sequence == 3) {
      EXPECT_EQ(m.outcome, record::kWaiting);
    }
  }
  EXPECT_EQ(to, 2U);
  EXPECT_GE(from, 3U);
  ASSERT_TRUE(recorder_.header.suts.at(0).controller);
  EXPECT_EQ(recorder_.header.suts[0].controller->name, "echo");
  EXPECT_EQ(recorder_.header.suts[0].controller->link_latency, milliseconds(1));
}

TEST_F(ControllerLinksTest, ALineThatIsFullLosesTheNewest) {
  make_links(1, {.baud = 9'600, .own = 0});
  Script script(4, to_controller({}, 1, 500));  // 0.52 s each
  script.push_back(finish(std::chrono::seconds(3)));
  run(std::move(script));
  std::vector<std::string> outcomes;
  for (const auto& m : recorder_.autopilot)
    if (m.to_controller) outcomes.push_back(m.outcome);
  std::ranges::sort(outcomes);
  EXPECT_THAT(outcomes, ElementsAre("delivered", "delivered", "queue_full", "queue_full"));
  EXPECT_EQ(taken_[0].size(), 2U);
}

TEST_F(ControllerLinksTest, AnInboxThatIsFullLosesTheNewestAndLeavesTheRadioAlone) {
  make_links(1, {.own = 300}, 1);
  options_.radio.inbox_messages = 2;
  remake();
  server_->add_sut(hello(name_of(0)), {receive(milliseconds(50), {}), finish({})});
  server_->add_sut(hello(name_of(1)), {send(milliseconds(30)), finish({})});
  ASSERT_EQ(run().end, RunEnd::kFinished);
  std::map<std::string, int> outcomes;
  for (const record::AutopilotMessage& m : recorder_.autopilot) ++outcomes[m.outcome];
  EXPECT_EQ(outcomes["delivered"], 1024);
  EXPECT_EQ(outcomes["inbox_full"], 13 * 300 - 1024);
  ASSERT_EQ(recorder_.radio.size(), 1U);
  EXPECT_EQ(recorder_.radio[0].outcome, record::kDelivered);
}

TEST_F(ControllerLinksTest, ACommandBesideAFlightControllerEndsTheRun) {
  make_links(1, {});
  const RunReport report = run({turn({}, 0.1), finish({})});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("flight controller"));
  EXPECT_THAT(report.reason, HasSubstr("send them to \"autopilot\""));
}

TEST_F(ControllerLinksTest, WithoutAControllerThereIsNoAutopilot) {
  const RunReport report = run({to_controller({}, 1), finish({})});
  EXPECT_EQ(report.end, RunEnd::kSutLost);
  EXPECT_THAT(report.reason, HasSubstr("\"autopilot\""));
}

TEST_F(ControllerLinksTest, AFlooderLosesItsSessionAndTheOthersAreUnharmed) {
  for (const bool floods : {false, true}) {
    make_links(2, {});
    Script flood(floods ? 1'500 : 1, to_controller({}, 0xFFFF, 2'000));
    flood.push_back(finish(milliseconds(1)));
    server_->add_sut(hello(name_of(0)), std::move(flood));
    Script honest;
    for (std::uint64_t i = 1; i <= 20; ++i) {
      honest.push_back(to_controller(milliseconds(1), i));
      honest.push_back(receive({}, milliseconds(9)));
    }
    honest.push_back(finish(milliseconds(5)));
    server_->add_sut(hello(name_of(1)), std::move(honest));
    const RunReport report = run();
    EXPECT_EQ(report.end, floods ? RunEnd::kFlooded : RunEnd::kFinished) << report.reason;
    EXPECT_TRUE(report.suts.at(1).finish);
    EXPECT_EQ(taken_[1].size(), 20U);
    for (std::size_t i = 0; i < taken_[1].size(); ++i) {
      EXPECT_EQ(taken_[1][i].number, i + 1);
      EXPECT_LE(taken_[1][i].at, st_ms(4 * static_cast<std::int64_t>(i) + 4));
    }
  }
}

// ---- Any schedule ----

struct Interleaving {
  std::size_t uavs = 1;
  Duration period, latency;
  double baud = 0.0;
  std::size_t size = 8;
  bool is_shared = false, is_concurrent = false, is_free = false;
  std::vector<std::vector<Script>> scripts;  // of each UAV: its threads
};

Interleaving draw(std::uint64_t seed) {
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
      for (int k = 0; k < 120; ++k) {
        const Duration compute = microseconds(10) * (random.bits() % 60);
        const std::uint32_t what = random.bits() % 8;
        if (what < 2) script.push_back(to_controller(compute, ++number, 8 + random.bits() % 40));
        if (what == 2) script.push_back(sleep(compute, microseconds(random.bits() % 3'000)));
        if (what == 3 && k % 20 == 0) script.push_back(read(compute, kRange));
        if (what >= 4) script.push_back(receive(compute, microseconds(random.bits() % 5'000)));
      }
    }
    for (int k = 0; k < 12; ++k) threads[0].push_back(receive({}, milliseconds(3)));
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
      if (i >= taken.size()) {
        EXPECT_GT(next_step(arrives_at, run.period), end - milliseconds(1)) << "none lost";
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
      EXPECT_GE(same_instant(entry.reply_at), entry.received->arrived_at) << "from the future";
    }
    for (const link::Reply& reply : replies_to(static_cast<link::PeerId>(uav + 1))) {
      if (!reply.message) continue;
      EXPECT_EQ((to_ns(reply.message->sent_at) - 1) % run.period.count(), 0);
      EXPECT_GE(reply.message->arrived_at, reply.message->sent_at + run.latency);
      if (run.baud == 0.0) {
        EXPECT_EQ(reply.message->arrived_at, reply.message->sent_at + run.latency);
      }
      EXPECT_GE(same_instant(reply.resume_at), reply.message->arrived_at);
      const std::uint64_t number = number_of(reply.message->bytes);
      if (number < kEcho) {
        if (run.scripts[uav].size() == 1) {
          EXPECT_EQ(number, ++own) << "in order";
        }
      } else {
        ASSERT_LT(echoes, taken_[uav].size());
        if (run.scripts[uav].size() == 1) {
          EXPECT_EQ(number - kEcho, taken_[uav][echoes].number) << "in order";
        }
        EXPECT_EQ(reply.message->sent_at, taken_[uav][echoes].at + Duration(1))
            << "at the step that has taken it";
        ++echoes;
      }
    }
  }

  std::uint64_t messages_ = 0;
};

TEST_F(InterleavingTest, KeepsTheRulesOnAnySchedule) {
  // A sanitizer, which looks for other faults, is several times slower.
  constexpr bool kIsSanitized = TETHER_ADDRESS_SANITIZER || TETHER_THREAD_SANITIZER;
  for (std::uint64_t seed = 1; messages_ < (kIsSanitized ? 20'000 : 100'000); ++seed) {
    const Interleaving run = draw(seed);
    std::string first;
    for (std::uint64_t schedule = 1; schedule <= 2; ++schedule) {
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
}

}  // namespace
}  // namespace tether::coordinator

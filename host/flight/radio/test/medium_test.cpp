#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/radio/medium.h>

namespace tether::radio {
namespace {

std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back("uav" + std::to_string(i));
  return out;
}

Message message(std::size_t from, std::int64_t at_ns, std::uint64_t sequence = 1,
                std::size_t bytes = 100, std::optional<std::size_t> to = {}) {
  return {from, to, sequence, from_ns<SimTime>(at_ns),
          std::make_shared<const std::vector<std::uint8_t>>(bytes)};
}

Link near(std::size_t, std::size_t) {
  return {.distance_m = 5.0};
}

std::vector<Arrival> run(Medium& medium, const Medium::LinkOf& link_of = near) {
  std::vector<Arrival> out;
  while (medium.next()) medium.handle_next(link_of, out);
  return out;
}

Settings log_distance(Access access = Access::kCsma) {
  Settings settings;
  settings.model = Model::kLogDistance;
  settings.access = access;
  return settings;
}

TEST(IdealMedium, DeliversToOneOrToAllAfterItsDelay) {
  Settings settings;
  for (const Duration delay : {Duration(0), Duration(7)}) {
    settings.delay = delay;
    Medium medium(settings, 1, names(3));
    medium.send(message(1, 10));
    medium.send(message(0, 20, 1, 0, 2));
    const auto arrivals = run(medium);
    ASSERT_EQ(arrivals.size(), 3U);
    EXPECT_EQ(arrivals[0].to, 0U);
    EXPECT_EQ(arrivals[1].to, 2U);
    EXPECT_EQ(arrivals[2].to, 2U);
    EXPECT_EQ(arrivals[1].at, from_ns<SimTime>(10) + delay);
    EXPECT_EQ(arrivals[2].at, from_ns<SimTime>(20) + delay);
  }
}

TEST(IdealMedium, OrdersOneInstantBySenderAndSequence) {
  Medium medium(Settings{}, 1, names(3));
  medium.send(message(2, 10, 4));
  medium.send(message(2, 10, 5));
  medium.send(message(1, 10, 9));
  std::vector<std::pair<std::size_t, std::uint64_t>> order;
  for (const Arrival& arrival : run(medium))
    if (arrival.to == 0) order.emplace_back(arrival.message.from, arrival.message.sequence);
  EXPECT_EQ(order, (decltype(order){{1, 9}, {2, 4}, {2, 5}}));
}

Settings distribution() {
  Settings settings;
  settings.model = Model::kDistribution;
  settings.data_rate_bit_s = 0.0;
  return settings;
}

TEST(DrawnMedium, DelaysEachReceiverByItsOwnDrawSoMessagesOvertake) {
  Settings settings = distribution();
  settings.delay = Duration(1000);
  settings.drawn_delay = uav::EmpiricalDelay{{Duration(300), Duration(50), Duration(100)}};
  settings.data_rate_bit_s = 8e9;  // a byte takes 1 ns
  EXPECT_EQ(least_delay(settings), Duration(1050));
  Medium medium(settings, 1, names(3));
  constexpr int kMessages = 300;
  for (int i = 0; i < kMessages; ++i)
    medium.send(message(0, 100 * i, static_cast<std::uint64_t>(i + 1), 7));
  std::map<std::int64_t, int> delays_ns;
  std::map<std::uint64_t, SimTime> first;
  int apart = 0, overtaken = 0;
  std::uint64_t newest = 0;
  SimTime last{};
  const auto arrivals = run(medium);
  ASSERT_EQ(arrivals.size(), 2U * kMessages);
  for (const Arrival& arrival : arrivals) {
    EXPECT_EQ(arrival.outcome, Outcome::kDelivered);
    ++delays_ns[(arrival.at - arrival.message.sent_at).count()];
    const auto [other, is_new] = first.try_emplace(arrival.message.sequence, arrival.at);
    apart += !is_new && other->second != arrival.at ? 1 : 0;
    EXPECT_GE(arrival.at, last);
    last = arrival.at;
    if (arrival.to != 1) continue;
    overtaken += arrival.message.sequence < newest ? 1 : 0;
    newest = std::max(newest, arrival.message.sequence);
  }
  EXPECT_EQ(delays_ns.size(), 3U);
  for (const std::int64_t ns : {1057, 1107, 1307}) EXPECT_NEAR(delays_ns[ns], 200, 45) << ns;
  EXPECT_NEAR(apart, 200, 45);
  EXPECT_GT(overtaken, 50);
}

// Bursts have a mean length of 1 / end; outside of them, each message is dropped by itself.
TEST(DrawnMedium, DropsByItselfAndInBursts) {
  Settings settings = distribution();
  settings.loss_probability = 0.1;
  settings.burst_begin_probability = 0.02;
  settings.burst_end_probability = 0.125;
  Medium medium(settings, 1, names(2));
  constexpr int kMessages = 50'000;
  for (int i = 0; i < kMessages; ++i)
    medium.send(message(0, i, static_cast<std::uint64_t>(2 * i + 1), 7));
  int dropped = 0, long_runs = 0, run_length = 0;
  for (const Arrival& arrival : run(medium)) {
    const bool is_dropped = arrival.outcome == Outcome::kDropped;
    dropped += is_dropped ? 1 : 0;
    run_length = is_dropped ? run_length + 1 : 0;
    long_runs += run_length == 5 ? 1 : 0;
  }
  const double in_bursts = 0.02 / (0.02 + 0.125);
  EXPECT_NEAR(1.0 * dropped / kMessages, in_bursts + 0.1 * (1.0 - in_bursts), 0.015);
  EXPECT_GT(long_runs, 300) << "independent losses of the same share have some 20";
}

TEST(DrawnMedium, WhatIsInTransitIsKnownForEachReceiver) {
  Settings settings = distribution();
  settings.delay = Duration(1000);
  settings.loss_probability = 1.0;
  Medium medium(settings, 1, names(3));
  medium.send(message(0, 10));
  std::vector<Arrival> out;
  medium.handle_next(near, out);
  EXPECT_TRUE(out.empty());
  const auto waiting = medium.in_transit(from_ns<SimTime>(500));
  ASSERT_EQ(waiting.size(), 2U);
  EXPECT_EQ(waiting[0].outcome, Outcome::kWaiting);
  EXPECT_EQ(waiting[0].to, 1U);
  EXPECT_EQ(waiting[1].to, 2U);
}

TEST(Medium, TooWeakASignalIsNoise) {
  Medium medium(log_distance(), 1, names(2));
  medium.send(message(0, 0));
  const auto arrivals = run(medium, [](auto, auto) { return Link{.distance_m = 1e5}; });
  ASSERT_EQ(arrivals.size(), 1U);
  EXPECT_EQ(arrivals[0].outcome, Outcome::kNoise);
}

// Both hear the receiver, but not each other: the hidden terminal.
TEST(Medium, HiddenTerminalsCollide) {
  Medium medium(log_distance(), 1, names(3));
  medium.send(message(0, 0, 1, 1000, 1));
  medium.send(message(2, 100'000, 1, 1000, 1));
  const auto arrivals = run(medium, [](std::size_t a, std::size_t b) {
    return Link{.distance_m = a + b == 2 && a != b ? 1e6 : 5.0};
  });
  ASSERT_EQ(arrivals.size(), 2U);
  for (const Arrival& arrival : arrivals) EXPECT_EQ(arrival.outcome, Outcome::kCollision);
}

TEST(Medium, WaitsWhileItHearsAnother) {
  Medium medium(log_distance(), 1, names(2));
  medium.send(message(0, 0, 1, 1000));
  medium.send(message(1, 500'000, 1, 1000));
  const auto arrivals = run(medium);
  ASSERT_EQ(arrivals.size(), 2U);
  EXPECT_EQ(arrivals[1].outcome, Outcome::kDelivered);
  EXPECT_GT(*arrivals[1].began_at, arrivals[0].at);
}

TEST(Medium, CannotHearWhileItTransmits) {
  Settings settings = log_distance();
  settings.carrier_sense_dbm = 100.0;  // nobody waits
  Medium medium(settings, 1, names(2));
  medium.send(message(0, 0, 1, 1000));
  medium.send(message(1, 500'000, 1, 1000));
  for (const Arrival& arrival : run(medium)) EXPECT_EQ(arrival.outcome, Outcome::kHalfDuplex);
}

TEST(Medium, AFullQueueDropsTheNewest) {
  Settings settings = log_distance();
  settings.queue_messages = 3;
  Medium medium(settings, 1, names(2));
  for (std::uint64_t k = 1; k <= 5; ++k) medium.send(message(0, 0, k, 1000));
  std::set<std::uint64_t> dropped;
  for (const Arrival& arrival : run(medium))
    if (arrival.outcome == Outcome::kQueueFull) dropped.insert(arrival.message.sequence);
  EXPECT_EQ(dropped, (std::set<std::uint64_t>{4, 5}));
}

TEST(Tdma, TransmitsInItsOwnSlots) {
  Settings settings = log_distance(Access::kTdma);
  settings.slot = Duration(1'000'000);
  Medium medium(settings, 1, names(4));
  medium.send(message(2, 100'000));
  medium.send(message(2, 100'000, 2));
  medium.send(message(1, 1'990'000));
  medium.send(message(3, 0, 1, 5000));
  std::map<std::pair<std::size_t, std::uint64_t>, Arrival> by_message;
  for (const Arrival& arrival : run(medium))
    by_message[{arrival.message.from, arrival.message.sequence}] = arrival;
  EXPECT_EQ(by_message.at({2, 1}).began_at, from_ns<SimTime>(2'000'000));
  EXPECT_EQ(by_message.at({2, 2}).began_at, by_message.at({2, 1}).at);
  EXPECT_EQ(by_message.at({1, 1}).began_at, from_ns<SimTime>(5'000'000)) << "too late in its slot";
  EXPECT_EQ(by_message.at({3, 1}).outcome, Outcome::kTooLong);
}

TEST(Medium, KnowsWhatIsInTransit) {
  Medium medium(log_distance(), 1, names(3));
  medium.send(message(0, 0, 1));
  medium.send(message(0, 0, 2, 10, 2));
  std::vector<Arrival> out;
  medium.handle_next(near, out);
  const auto waiting = medium.in_transit(from_ns<SimTime>(50));
  ASSERT_EQ(waiting.size(), 3U);
  for (const Arrival& arrival : waiting) EXPECT_EQ(arrival.outcome, Outcome::kWaiting);
}

class RandomTraffic : public testing::TestWithParam<Access> {
 protected:
  // Random messages of random UAVs in a room with random places.
  std::vector<Arrival> run_random(std::uint64_t seed) {
    KeyedRandom random({.seed = seed});
    settings_ = log_distance(GetParam());
    settings_.slot = GetParam() == Access::kTdma ? Duration(2'000'000) : Duration(9'000);
    settings_.queue_messages = 4;
    settings_.shadowing_db = 4.0;
    settings_.exponent = 3.0;
    const std::size_t count = 2 + random.bits() % 5;
    std::vector<double> place_m(count);
    for (double& x : place_m) x = 150.0 * random.uniform();
    Medium medium(settings_, seed, names(count));
    sent_ = 0;
    std::int64_t at_ns = 0;
    std::vector<Arrival> out;
    const auto link_of = [&](std::size_t a, std::size_t b) {
      return Link{std::abs(place_m[a] - place_m[b]), static_cast<int>((a + b) % 3)};
    };
    for (std::uint64_t k = 1; k <= 200; ++k) {
      at_ns += static_cast<std::int64_t>(random.uniform() * 1e6);
      const std::size_t from = random.bits() % count;
      const bool to_all = random.bits() % 2;
      std::optional<std::size_t> to;
      if (!to_all) to = (from + 1 + random.bits() % (count - 1)) % count;
      const std::size_t bytes = random.bits() % 1000;
      while (medium.next() && medium.next()->at < from_ns<SimTime>(at_ns))
        medium.handle_next(link_of, out);
      medium.send(message(from, at_ns, k, bytes, to));
      sent_ += to_all ? count - 1 : 1;
    }
    while (medium.next()) medium.handle_next(link_of, out);
    return out;
  }

  Settings settings_;
  std::size_t sent_ = 0;
};

TEST_P(RandomTraffic, EachMessageHasOneFateAtEachReceiver) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto arrivals = run_random(seed);
    EXPECT_EQ(arrivals.size(), sent_);
    std::set<std::pair<std::uint64_t, std::size_t>> seen;
    for (const Arrival& arrival : arrivals) {
      EXPECT_TRUE(seen.insert({arrival.message.sequence, arrival.to}).second);
      EXPECT_NE(arrival.to, arrival.message.from);
    }
  }
}

TEST_P(RandomTraffic, NothingArrivesBeforeItsAirTime) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SimTime last{};
    for (const Arrival& arrival : run_random(seed)) {
      if (arrival.outcome != Outcome::kDelivered) continue;
      const Duration air = air_time(settings_, arrival.message.bytes->size());
      EXPECT_EQ(arrival.at, *arrival.began_at + air);
      EXPECT_GE(*arrival.began_at, arrival.message.sent_at);
      EXPECT_GE(arrival.at, arrival.message.sent_at + least_delay(settings_));
      EXPECT_GE(arrival.at, last) << "in the order of time";
      last = arrival.at;
    }
  }
}

TEST_P(RandomTraffic, NobodyHearsWhileItTransmits) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto arrivals = run_random(seed);
    for (const Arrival& heard : arrivals) {
      if (heard.outcome != Outcome::kDelivered) continue;
      for (const Arrival& own : arrivals) {
        if (own.message.from != heard.to || !own.began_at) continue;
        EXPECT_TRUE(own.at <= *heard.began_at || *own.began_at >= heard.at);
      }
    }
  }
}

TEST_P(RandomTraffic, IsAFunctionOfItsSeed) {
  const auto outcomes = [&](std::uint64_t seed) {
    std::vector<std::tuple<SimTime, std::size_t, Outcome>> out;
    for (const Arrival& arrival : run_random(seed))
      out.emplace_back(arrival.at, arrival.to, arrival.outcome);
    return out;
  };
  EXPECT_EQ(outcomes(3), outcomes(3));
  EXPECT_NE(outcomes(3), outcomes(4));
}

INSTANTIATE_TEST_SUITE_P(Access, RandomTraffic, testing::Values(Access::kCsma, Access::kTdma),
                         [](const auto& access) {
                           return std::string(access.param == Access::kCsma ? "Csma" : "Tdma");
                         });

TEST(Medium, FewerArriveFromFartherAway) {
  std::size_t last = 400;
  for (const double distance_m : {10.0, 100.0, 300.0, 500.0, 1000.0, 5000.0}) {
    Medium medium(log_distance(), 1, names(2));
    for (std::uint64_t k = 1; k <= 400; ++k)
      medium.send(message(0, static_cast<std::int64_t>(k) * 2'000'000, k));
    std::size_t delivered = 0;
    for (const Arrival& arrival :
         run(medium, [&](auto, auto) { return Link{.distance_m = distance_m}; }))
      delivered += arrival.outcome == Outcome::kDelivered ? 1 : 0;
    EXPECT_LE(delivered, last) << distance_m;
    last = delivered;
  }
  EXPECT_EQ(last, 0U);
}

}  // namespace
}  // namespace tether::radio

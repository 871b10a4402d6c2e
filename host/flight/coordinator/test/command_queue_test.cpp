#include "command_queue.h"

#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>

#include <tether/base/random.h>

namespace tether::coordinator {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

SimTime st(std::int64_t ns) {
  return from_ns<SimTime>(ns);
}

CommandQueue queue_of(std::size_t uavs, Duration step = Duration(1),
                      std::optional<uav::SetpointLoss> loss = std::nullopt) {
  return {StepGrid(step), std::vector<std::optional<uav::SetpointLoss>>(uavs, loss)};
}

std::vector<uav::TimedSetpoint> points(std::initializer_list<std::int64_t> after_ns) {
  std::vector<uav::TimedSetpoint> list;
  for (const std::int64_t ns : after_ns) list.push_back({Duration(ns), {}});
  return list;
}

/// "sequence.index", with "!" for a loss, of all that is due by then.
std::vector<std::string> pop(CommandQueue& queue, std::int64_t until_ns) {
  std::vector<std::string> out;
  while (const auto effect = queue.pop_due(st(until_ns)))
    out.push_back(std::to_string(effect->sequence) + "." + std::to_string(effect->index) +
                  (effect->loss ? "!" : ""));
  return out;
}

TEST(CommandQueue, ReturnsAndCountsCommandsInTheOrderOfEffectThenUav) {
  CommandQueue queue = queue_of(2);
  EXPECT_EQ(queue.next_effect(), SimTime::max());
  queue.push({st(10), 1, 2, points({0})});
  queue.push({st(30), 1, 3, points({0})});
  queue.push({st(10), 0, 4, points({0})});
  queue.push({st(30), 0, 6, points({0})});
  EXPECT_EQ(queue.next_effect(), st(10));
  EXPECT_EQ(queue.waiting(0), 2u);
  EXPECT_THAT(pop(queue, 9), ElementsAre());
  EXPECT_THAT(pop(queue, 10), ElementsAre("4.0", "2.0"));
  EXPECT_THAT(pop(queue, 29), ElementsAre());
  EXPECT_THAT(pop(queue, 40), ElementsAre("6.0", "3.0"));
  EXPECT_EQ(queue.waiting(0), 0u);
  EXPECT_EQ(queue.next_effect(), SimTime::max());
}

TEST(CommandQueue, ACommandDoesNotOvertakeAnotherOfItsUav) {
  CommandQueue queue = queue_of(2);
  EXPECT_EQ(queue.push({st(30), 0, 1, points({0})}), st(30));
  EXPECT_EQ(queue.push({st(10), 0, 2, points({0})}), st(30));
  EXPECT_EQ(queue.push({st(10), 1, 9, points({0})}), st(10));
  EXPECT_THAT(pop(queue, 30), ElementsAre("9.0", "1.0", "2.0"));
}

TEST(CommandQueue, ATrajectoryIsFollowedUntilTheNextCommandArrives) {
  CommandQueue queue = queue_of(1, Duration(10));
  queue.push({st(5), 0, 1, points({0, 10, 12, 30, 45})});  // at 5, 15, 17, 35, 50
  EXPECT_EQ(queue.waiting(0), 5u);
  EXPECT_EQ(queue.next_effect(), st(10));
  EXPECT_THAT(pop(queue, 10), ElementsAre("1.0"));
  EXPECT_EQ(queue.next_effect(), st(20));
  EXPECT_THAT(pop(queue, 20), ElementsAre("1.1", "1.2"));
  queue.push({st(35), 0, 2, points({0})});
  EXPECT_THAT(pop(queue, 100), ElementsAre("1.3", "2.0")) << "at one instant, the one before first";
  EXPECT_EQ(queue.waiting(0), 0u);
  EXPECT_EQ(queue.next_effect(), SimTime::max());
}

TEST(CommandQueue, ALossComesOnceAndOnlyAfterItsTimeout) {
  const uav::SetpointLoss loss{.timeout = Duration(20), .action = uav::LossAction::kBrake};
  CommandQueue queue = queue_of(1, Duration(10), loss);
  EXPECT_THAT(pop(queue, 1000), ElementsAre()) << "before the first command";
  queue.push({st(1000), 0, 1, points({0})});
  queue.push({st(1020), 0, 2, points({0, 15})});  // in time; until 1035
  EXPECT_THAT(pop(queue, 1050), ElementsAre("1.0", "2.0", "2.1"));
  EXPECT_EQ(queue.next_effect(), st(1060));
  EXPECT_THAT(pop(queue, 5000), ElementsAre("2.1!"));
  EXPECT_EQ(queue.next_effect(), SimTime::max());
  queue.push({st(6000), 0, 3, points({0})});
  EXPECT_THAT(pop(queue, 6000), ElementsAre("3.0")) << "the link is back";
}

// What takes effect does not depend on when commands become known, as long as that is before they
// arrive.
TEST(CommandQueue, EffectsDoNotDependOnWhenCommandsAreKnown) {
  for (std::uint64_t run = 0; run < 300; ++run) {
    KeyedRandom random({11, run, 0});
    const uav::SetpointLoss loss{Duration(1 + random.bits() % 60), uav::LossAction::kBrake};
    CommandQueue early = queue_of(2, Duration(10), loss), late = queue_of(2, Duration(10), loss);
    std::vector<PendingCommand> commands;
    SimTime at{};
    for (std::uint64_t i = 1; i <= 30; ++i) {
      at += Duration(random.bits() % 40);
      commands.push_back({at, random.bits() % 2, i, points({0})});
      for (std::uint32_t k = random.bits() % 4; k > 0; --k)
        commands.back().setpoints.push_back(
            {commands.back().setpoints.back().after + Duration(1 + random.bits() % 25), {}});
    }
    for (const PendingCommand& command : commands) early.push(command);
    std::vector<std::string> of_early, of_late;
    auto next = commands.begin();
    for (std::int64_t t = 0; t <= 3000; t += 10) {
      // As late as the barrier allows: when ST is at the boundary before.
      for (; next != commands.end() && next->arrives_at <= st(t); ++next) late.push(*next);
      std::ranges::copy(pop(early, t), std::back_inserter(of_early));
      std::ranges::copy(pop(late, t), std::back_inserter(of_late));
    }
    ASSERT_EQ(of_early, of_late) << run;
    ASSERT_EQ(early.waiting(0) + late.waiting(0) + late.waiting(1), 0u);
  }
}

}  // namespace
}  // namespace tether::coordinator

#include <utility>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>
#include <tether/scenario/scenario.h>

namespace tether::scenario {
namespace {

/// The other kinds of work cost as much as the first one.
Target counted(std::initializer_list<std::uint64_t> costs) {
  Target target;
  target.file = "/counted.toml";
  target.clock.kind = computer::ClockKind::kCounted;
  os::Emulator& emulator = target.emulator.emplace();
  emulator.program = "qemu-x86_64";
  emulator.cost_units.fill(*costs.begin());
  std::copy(costs.begin(), costs.end(), emulator.cost_units.begin());
  return target;
}
Condition on(const Target& target) {
  Condition condition;
  condition.computers[0].clock = target.clock;
  condition.computers[0].clock.factor = target.clock.factor;
  condition.computers[0].target = target;
  return condition;
}

TEST(Slowness, IsTheRatioOfTheFactors) {
  Target board;
  board.clock.kind = computer::ClockKind::kCpu;
  board.clock.factor = 6.0;
  Condition condition;
  condition.computers[0].clock.kind = computer::ClockKind::kCpu;
  condition.computers[0].clock.factor = 2.0;
  EXPECT_EQ(slowness(board, {}, condition).factor, 3.0);
  EXPECT_FALSE(slowness(board, {}, condition).bounds);
  board.cpu_factor_interval = {5.0, 8.0};
  EXPECT_EQ(slowness(board, {}, condition).bounds, std::pair(2.5, 4.0));
}

TEST(Slowness, OfCountedTargetsIsWithinTheRatiosOfTheirCosts) {
  const Condition condition = on(counted({10, 20, 10, 40}));
  const Slowness uneven = slowness(counted({20, 40, 20, 320}), {}, condition);
  EXPECT_EQ(uneven.bounds, std::pair(2.0, 8.0));
  EXPECT_DOUBLE_EQ(uneven.factor, 4.0);
  EXPECT_EQ(slowness(counted({60, 120, 60, 240}), {}, condition).bounds, std::pair(6.0, 6.0));
}

TEST(Slowness, IsRefusedWhereThereIsNone) {
  const Condition condition = on(counted({10, 20}));
  Target over_ssh;
  over_ssh.ssh.emplace();
  Target by_factor;
  by_factor.clock.kind = computer::ClockKind::kCpu;
  Target of_another_model = counted({10, 20});
  of_another_model.emulator->cpu_model = "another";
  for (const Target& target : {over_ssh, by_factor, of_another_model})
    EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { slowness(target, {}, condition); }).subject(),
              target.file.string());
  Condition scripted;
  scripted.computers[0].clock.kind = computer::ClockKind::kScripted;
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { slowness(by_factor, {}, scripted); }).subject(),
            "");
}

TEST(Slowness, IsRefusedWhereTheTargetDiffersInMoreThanSpeed) {
  Condition condition;
  condition.computers[0].clock.kind = computer::ClockKind::kCpu;
  Target target;
  target.file = "/t.toml";
  target.clock.kind = computer::ClockKind::kCpu;
  Scenario scenario;
  target.power = energy::Computer{120.0, 0.0};
  scenario.uavs.emplace_back();
  EXPECT_EQ(slowness(target, scenario, condition).factor, 1.0);  // no energy is simulated
  scenario.uavs[0].energy.emplace().model.computer = *target.power;
  EXPECT_EQ(slowness(target, scenario, condition).factor, 1.0);
  const auto expect_refused = [&] {
    EXPECT_EQ(
        thrown_error(ErrorCode::kUsage, [&] { slowness(target, scenario, condition); }).subject(),
        "/t.toml");
  };
  scenario.uavs[0].energy->model.computer.idle_W = 4.0;
  expect_refused();
  condition.computers[0].target = target;
  EXPECT_EQ(slowness(target, scenario, condition).factor, 1.0);
  target.launcher = {"wrapper"};
  expect_refused();
  std::swap(target.launcher, condition.computers[0].target->launcher);
  expect_refused();
}

}  // namespace
}  // namespace tether::scenario

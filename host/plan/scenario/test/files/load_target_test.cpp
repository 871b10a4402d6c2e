#include "test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/scenario/target.h>

namespace tether::scenario {
namespace {

using testing::ElementsAre;

const std::string kCountedTarget = R"(name = "counted"
clock = "counted"
emulator = "qemu-aarch64"
cpu_model = "cortex-a72"
sysroot = "../sysroot"
[cost_ns]
integer = 0.3
multiply = 1.1
divide = 7.7
load = 0.5
store = 0.4
branch = 0.6
scalar_float = 1.3
vector_float = 1.7
vector_integer = 0.9
atomic = 11
)";

class LoadTarget : public testing::Test {
 protected:
  Target load(const std::string& text) const {
    return load_target(scratch_.write("targets/t.toml", text));
  }
  ScratchFolder scratch_;
};

TEST_F(LoadTarget, ReadsAVirtualTarget) {
  const Target target = load(kFullTarget);
  EXPECT_EQ(target.file, scratch_.path("targets/t.toml"));
  EXPECT_EQ(target.name, "slow");
  EXPECT_EQ(target.description, "every key");
  EXPECT_FALSE(target.ssh);
  EXPECT_EQ(target.clock.kind, computer::ClockKind::kCpu);
  EXPECT_EQ(target.clock.factor, 6.5);
  EXPECT_EQ(target.cores, 2);
  EXPECT_THAT(target.launcher, ElementsAre("qemu-aarch64", "-L", scratch_.path("sysroot")));
  EXPECT_EQ(target.program_folder, scratch_.path("arm64/bin"));
  EXPECT_THAT(load("name = \"a\"\nlauncher = [\"./run\", \"a/b\", \"..\"]\n").launcher,
              ElementsAre(scratch_.path("targets/run"), "a/b", ".."));
}

TEST_F(LoadTarget, ReadsABoardAndLeavesItsPathsUnchanged) {
  const Target target = load(kBoardTarget);
  ASSERT_TRUE(target.ssh);
  EXPECT_EQ(target.ssh->destination, "user@board");
  EXPECT_EQ(target.ssh->port, 2222);
  EXPECT_EQ(target.clock.kind, computer::ClockKind::kWall);
  EXPECT_THAT(target.launcher, ElementsAre("nice", "-n", "-5", "./wrap"));
  EXPECT_EQ(target.program_folder, "bin");
  EXPECT_EQ(load(kBoardTarget + "clock = \"wall\"\n").clock.kind, computer::ClockKind::kWall);
}

TEST_F(LoadTarget, ReadsACountedTarget) {
  const Target target = load(kCountedTarget);
  EXPECT_EQ(target.clock.kind, computer::ClockKind::kCounted);
  ASSERT_TRUE(target.emulator);
  EXPECT_EQ(target.emulator->program, "qemu-aarch64");
  EXPECT_EQ(target.emulator->cpu_model, "cortex-a72");
  EXPECT_EQ(target.emulator->sysroot, scratch_.path("sysroot"));
  EXPECT_EQ(target.emulator->cost_units[0], 30'000u) << "integer";
  EXPECT_EQ(target.emulator->cost_units[9], 1'100'000u) << "atomic";
  EXPECT_THAT(target.launcher, ElementsAre("qemu-aarch64"));
}

TEST_F(LoadTarget, RefusesWrongValuesOfACountedTarget) {
  const std::vector<WrongChange> changes = {
      {"\"qemu-aarch64\"", "\"qemu-arm\"", 3, "emulator"},
      {"emulator = \"qemu-aarch64\"\n", "", 0, "emulator"},
      {"cpu_model = \"cortex-a72\"\n", "", 0, "cpu_model"},
      {"sysroot = \"../sysroot\"", "cpu_factor = 2", 5, "cpu_factor"},
      {"sysroot = \"../sysroot\"", "launcher = [\"nice\"]", 5, "launcher"},
      {"sysroot = \"../sysroot\"", "address = \"ssh://board\"", 2, "clock"},
      {"clock = \"counted\"", "clock = \"cpu\"", 3, "emulator"},
      {"branch = 0.6", "branch = -0.6", 12, "branch"},
      {"branch = 0.6", "branch = 1e5", 12, "branch"},
      {"branch = 0.6", "branches = 0.6", 12, "branches"},
      {"branch = 0.6\n", "", 6, "branch"}};
  for (const WrongChange& change : changes)
    expect_refusal(change.line, change.subject,
                   [&] { load(replaced(kCountedTarget, change.from, change.to)); });
  const std::string head = kCountedTarget.substr(0, kCountedTarget.find("[cost_ns]"));
  expect_refusal(0, "cost_ns", [&] { load(head); });
}

TEST_F(LoadTarget, RefusesWorkThatTakesNoTime) {
  expect_refusal(13, "scalar_float", [&] {
    load(replaced(kCountedTarget, "scalar_float = 1.3", "scalar_float = 0.0"));
  });
  expect_refusal(13, "scalar_float", [&] {
    load(replaced(kCountedTarget, "scalar_float = 1.3", "scalar_float = 0.0009"));
  });
}

TEST_F(LoadTarget, IsThisHostByDefault) {
  const Target target = load("name = \"bare\"\n");
  EXPECT_EQ(target.clock.kind, computer::ClockKind::kWall);
  EXPECT_EQ(target.clock.factor, 1.0);
  EXPECT_EQ(target.cores, 0);
  EXPECT_TRUE(target.launcher.empty() && target.program_folder.empty());
}

TEST_F(LoadTarget, RefusesWrongValues) {
  const std::vector<WrongChange> changes = {
      {"\"slow\"", "\"my board\"", 1, "name"},
      {"\"slow\"", "\"-_-\"", 1, "name"},
      {"\"cpu\"", "\"scripted\"", 3, "clock"},
      {"cores = 2", "cores = 0", 5, "cores"},
      {"[\"qemu-aarch64\", \"-L\", \"../sysroot\"]", "[]", 6, "launcher"}};
  for (const WrongChange& change : changes)
    expect_refusal(change.line, change.subject,
                   [&] { load(replaced(kFullTarget, change.from, change.to)); });
  for (const std::string address : {"board", "ssh://", "http://board"})
    expect_refusal(2, "address", [&] { load("name = \"a\"\naddress = \"" + address + "\"\n"); });
}

TEST_F(LoadTarget, ReadsTheIntervalOfAFactorAroundIt) {
  const std::string factor = "name = \"a\"\ncpu_factor = 2\ncpu_factor_interval = ";
  const auto interval = load(factor + "[1.5, 2.5]\n").cpu_factor_interval;
  ASSERT_TRUE(interval);
  EXPECT_EQ(*interval, std::pair(1.5, 2.5));
  for (const std::string wrong : {"[2.1, 2.5]", "[1.5, 1.9]", "[2]", "[0, 3]"})
    expect_refusal(3, "cpu_factor_interval", [&] { load(factor + wrong + "\n"); });
}

TEST_F(LoadTarget, RefusesKeysOfVirtualTargetsForABoard) {
  expect_refusal(5, "clock", [&] { load(kBoardTarget + "clock = \"cpu\"\n"); });
  expect_refusal(5, "cpu_factor", [&] { load(kBoardTarget + "cpu_factor = 2\n"); });
  expect_refusal(5, "cores", [&] { load(kBoardTarget + "cores = 2\n"); });
}

}  // namespace
}  // namespace tether::scenario

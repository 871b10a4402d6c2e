#include "test_files.h"

#include <gtest/gtest.h>

#include <tether/scenario/scenario.h>

// The computers of a fleet: [[target]], and who is on them.
namespace tether::scenario {
namespace {

const std::string kFleet = R"(name = "fleet"
world = "worlds/room.sdf"
time_limit_s = 10
[sut]
command = ["sut"]
[[target]]
name = "front"
clock = "cpu"
cpu_factor = 3
cores = 2
[[target]]
name = "rear"
clock = "scripted"
computing_ms = 4
[[uav]]
name = "a"
model = "models/uav.sdf"
position_m = [0, 0, 1]
target = "front"
[[uav]]
name = "b"
model = "models/uav.sdf"
position_m = [3, 0, 1]
target = "front"
pinned_core = 1
[[uav]]
name = "c"
model = "models/uav.sdf"
position_m = [6, 0, 1]
target = "rear"
[[condition]]
name = "shared"
policy = "conservative_barrier"
[[condition]]
name = "each"
policy = "conservative_barrier"
shared = false
[[condition]]
name = "host"
policy = "conservative_barrier"
clock = "cpu"
)";

class Seats : public testing::Test {
 protected:
  Scenario load(const std::string& text) { return load_scenario(write_project(scratch_, text)); }
  ScratchFolder scratch_;
};

TEST_F(Seats, EachUavRunsOnTheTargetThatItNames) {
  const Scenario fleet = load(kFleet);
  const Condition& shared = fleet.conditions[0];
  EXPECT_EQ(shared.computers.size(), 2u);
  EXPECT_EQ(shared.computers[0].cores, 2);
  EXPECT_TRUE(is_shared(shared, 0));
  EXPECT_FALSE(is_shared(shared, 1));
  EXPECT_EQ(shared.seats[1].pinned_core, 1);
  EXPECT_EQ(computer_of(shared, 1).clock.factor, 3.0);
  EXPECT_EQ(computer_of(shared, 2).clock.kind, computer::ClockKind::kScripted);
  EXPECT_EQ(computer_of(shared, 2).clock.computing, std::chrono::milliseconds(4));

  const Condition& each = fleet.conditions[1];
  ASSERT_EQ(each.computers.size(), 3u);
  EXPECT_EQ(each.computers[1].name, "front-b");
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(is_shared(each, i));
  EXPECT_EQ(computer_of(each, 1).clock.factor, 3.0);
  EXPECT_TRUE(fleet.conditions[2].seats.empty());
  EXPECT_EQ(computer_of(fleet.conditions[2], 1).clock.factor, 1.0);
}

TEST_F(Seats, ASettingKeepsTheFirstUavsWithTheirMetricsAndComputers) {
  std::string text = kFleet;
  for (const char* uav : {"a", "b", "c"})
    text += std::string("[[metric]]\nkind = \"time_required\"\nuav = \"") + uav + "\"\n";
  const std::filesystem::path file = write_project(scratch_, text);
  const Scenario two = load_scenario(file, {{"uavs", "2"}});
  EXPECT_EQ(two.name, "fleet-uavs-2");
  EXPECT_EQ(two.uavs.size(), 2u);
  ASSERT_EQ(two.metrics.size(), 2u);
  EXPECT_EQ(two.metrics[1].uav, "b");
  ASSERT_EQ(two.conditions[0].computers.size(), 1u) << "nothing runs on the other one";
  EXPECT_TRUE(is_shared(two.conditions[0], 0));
  EXPECT_EQ(two.conditions[1].computers.size(), 2u);
  EXPECT_EQ(computer_of(two.conditions[1], 1).name, "front-b");
  EXPECT_FALSE(is_shared(load_scenario(file, {{"uavs", "1"}}).conditions[0], 0));
  for (const char* wrong : {"0", "4", "2.5", "-1", ""}) {
    const Error error = thrown_error(ErrorCode::kUsage, [&] {
      load_scenario(file, {{"uavs", wrong}});
    });
    EXPECT_EQ(error.subject(), "uavs") << wrong;
  }
}

TEST_F(Seats, SlowDownAndTargetsReachEveryComputerAndKeepWhoShares) {
  Scenario fleet = load(kFleet);
  Condition& shared = fleet.conditions[0];
  slow_down(shared, 2.0);
  EXPECT_EQ(computer_of(shared, 0).clock.factor, 6.0);
  EXPECT_EQ(computer_of(shared, 2).clock.computing, std::chrono::milliseconds(8));
  Target slow;
  slow.clock.kind = computer::ClockKind::kCpu;
  slow.clock.factor = 7.0;
  place_on(shared, slow);
  EXPECT_EQ(computer_of(shared, 2).clock.factor, 7.0);
  EXPECT_TRUE(is_shared(shared, 0));
  slow.clock.kind = computer::ClockKind::kWall;
  EXPECT_EQ(thrown_error(ErrorCode::kUsage, [&] { place_on(shared, slow); }).subject(), shared.name)
      << "one is pinned";
  shared.seats[1].pinned_core.reset();
  place_on(shared, slow);
  const auto boards = real_boards(shared, 3);
  ASSERT_EQ(boards.size(), 1u);
  EXPECT_EQ(boards[0].name, "front");
  EXPECT_EQ(boards[0].uavs, (std::vector<std::size_t>{0, 1}));
}

TEST_F(Seats, RealBoardsAreThoseWithAWallClockAndSeveralUavs) {
  const Scenario fleet = load(kFleet);
  EXPECT_TRUE(real_boards(fleet.conditions[0], 3).empty()) << "its computers are modelled";
  const Scenario wall = load(
      replaced(replaced(kFleet, "clock = \"cpu\"\ncpu_factor = 3\ncores = 2", "clock = \"wall\""),
               "pinned_core = 1", ""));
  ASSERT_EQ(real_boards(wall.conditions[0], 3).size(), 1u);
  EXPECT_EQ(real_boards(wall.conditions[0], 3)[0].uavs.size(), 2u);
  EXPECT_TRUE(real_boards(wall.conditions[1], 3).empty()) << "not shared";
  Condition on_host;
  on_host.computers[0].clock.kind = computer::ClockKind::kWall;
  EXPECT_TRUE(real_boards(on_host, 3).empty());
  on_host.computers[0].target.emplace().name = "pi";
  on_host.computers[0].target->ssh = SshAddress{"pi@rover"};
  EXPECT_TRUE(real_boards(on_host, 1).empty());
  ASSERT_EQ(real_boards(on_host, 3).size(), 1u);
  EXPECT_EQ(real_boards(on_host, 3)[0].uavs, (std::vector<std::size_t>{0, 1, 2}));
}

TEST_F(Seats, RefusesWhatCannotBe) {
  const std::string board = "clock = \"wall\"\naddress = \"ssh://pi@rover\"\n";
  scratch_.write("pi.toml", "name = \"pi\"\n" + board);
  scratch_.write("same.toml", "name = \"same\"\n" + board);
  const std::string front = "clock = \"cpu\"\ncpu_factor = 3\n",
                    rear = "clock = \"scripted\"\ncomputing_ms = 4\n";
  const WrongChange changes[] = {
      {"target = \"rear\"", "target = \"back\"", 30, "target"},
      {"pinned_core = 1", "pinned_core = 2", 25, "pinned_core"},
      {"target = \"rear\"", "pinned_core = 0", 30, "pinned_core"},
      {"name = \"rear\"", "name = \"front\"", 12, "name"},
      {"cores = 2", "cores = 0", 10, "cores"},
      {"cpu_factor = 3\ncores = 2", "cores = 1025", 9, "cores"},
      {"clock = \"cpu\"\ncpu_factor = 3", "clock = \"wall\"", 9, "cores"},
      {front + "cores = 2", "clock = \"wall\"", 23, "pinned_core"},
      {"cores = 2", "cores = 1", 25, "pinned_core"},
      {"target = \"rear\"\n", "", 12, "rear"},
      {"target = \"rear\"", "target = \"front\"", 12, "rear"},
      {"target = \"front\"\npinned_core = 1\n", "", 29, "clock"},
      {front, "file = \"pi.toml\"\n", 9, "cores"},
      {front, "", 6, "clock"},
      {"shared = false", "shared = false\nclock = \"cpu\"", 37, "shared"},
  };
  for (const WrongChange& change : changes)
    expect_refusal(change.line, change.subject,
                   [&] { load(replaced(kFleet, change.from, change.to)); });
  const std::string full =
      replaced(replaced(kFleet, "cores = 2", "cores = 1"), "pinned_core = 1", "pinned_core = 0");
  expect_refusal(7, "front", [&] { load(full); });
  const std::string two =
      replaced(replaced(replaced(kFleet, front + "cores = 2\n", "file = \"pi.toml\"\n"), rear,
                        "file = \"same.toml\"\n"),
               "target = \"front\"\npinned_core = 1", "target = \"rear\"");
  expect_refusal(10, "rear", [&] { load(two); });
}

}  // namespace
}  // namespace tether::scenario

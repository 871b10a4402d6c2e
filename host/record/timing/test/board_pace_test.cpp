#include "board_pace.h"

#include <chrono>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tether::timing {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

WallTime wall(int at_ms) {
  return WallTime(milliseconds(1000 + at_ms));
}

/// SUTs "uav1", … on these computers, started at 0 ms of wall time.
record::Record fleet(const std::vector<std::string>& computers) {
  record::Record record;
  record.header.wall_at_start = wall(0);
  for (const std::string& computer : computers) {
    record::SutInfo sut;
    sut.uav = "uav" + std::to_string(record.header.suts.size() + 1);
    sut.computer = computer;
    record.header.suts.push_back(sut);
  }
  return record;
}

void add_call(record::Record& record, const std::string& uav, int arrival_ms, int release_ms) {
  record::Interaction call;
  call.uav = uav;
  call.wall_at_arrival = wall(arrival_ms);
  call.wall_at_release = wall(release_ms);
  record.interactions.push_back({SimTime{}, record.interactions.size(), call});
}

std::vector<Pace> paces(const std::vector<double>& p95_s) {
  std::vector<Pace> paces;
  for (const double one : p95_s)
    paces.push_back(
        {.uav = "uav" + std::to_string(paces.size() + 1), .median_s = 0.5 * one, .p95_s = one});
  return paces;
}

TEST(BoardPace, OfSeveralUavsIsThatOfTheMostExpensiveImages) {
  const auto boards = board_paces(fleet({"nano", "pi", "nano"}), paces({0.1, 0.02, 0.2}));
  ASSERT_EQ(boards.size(), 2u);
  EXPECT_EQ(boards[0].board, "nano");
  EXPECT_THAT(boards[0].uavs, ElementsAre("uav1", "uav3"));
  EXPECT_EQ(boards[0].p95_s, 0.2);
  EXPECT_EQ(boards[0].median_s, 0.1);
  EXPECT_EQ(boards[1].p95_s, 0.02);
  EXPECT_EQ(boards[1].alone, std::nullopt) << "no call has a wall time";
}

// nano computes in [0, 40] and [50, 100] ms, pi in [0, 10] and [60, 70].
TEST(BoardPace, CountsTheWallTimeInWhichNoOtherBoardComputed) {
  record::Record record = fleet({"nano", "pi"});
  add_call(record, "uav2", 10, 60);
  add_call(record, "uav1", 40, 50);
  add_call(record, "uav2", 70, 200);
  add_call(record, "uav1", 100, 200);
  const auto boards = board_paces(record, paces({0.1, 0.1}));
  EXPECT_NEAR(*boards[0].alone, 0.7, 1e-9);
  EXPECT_NEAR(*boards[1].alone, 0.0, 1e-9);
}

// A concurrent SUT computes while its calls are open, until it is stopped.
TEST(BoardPace, AConcurrentSutComputesFromItsRepliesToItsNextStop) {
  record::Record record = fleet({"nano", "pi"});
  record.header.suts[0].concurrent = true;
  add_call(record, "uav1", 5, 30);
  add_call(record, "uav2", 10, 40);
  for (const int stop_ms : {20, 80})
    record.stops.push_back({SimTime{}, 0, {"uav1", ExecTime{}, std::nullopt, wall(stop_ms)}});
  add_call(record, "uav2", 50, 100);
  const auto boards = board_paces(record, paces({0.1, 0.1}));
  EXPECT_NEAR(*boards[0].alone, (10 + 10 + 30) / 80.0, 1e-9);
  EXPECT_NEAR(*boards[1].alone, 0.0, 1e-9);
}

TEST(BoardPace, IsOfFleetsWithSeveralNamedComputers) {
  EXPECT_TRUE(board_paces(fleet({"nano", "nano"}), paces({0.1, 0.1})).empty());
  EXPECT_TRUE(board_paces(fleet({"", ""}), paces({0.1, 0.1})).empty());
  EXPECT_TRUE(board_paces(fleet({"nano"}), paces({0.1})).empty());
}

}  // namespace
}  // namespace tether::timing

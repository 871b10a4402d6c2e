#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <tether/base/random.h>
#include <tether/sizing/sizing.h>

namespace tether::sizing {
namespace {

TEST(ByUavs, BisectsUntilTwoNeighboursAreLeftThenDecidesBoth) {
  const UavQuestion question{.most = 8};
  struct Case {
    std::vector<UavLevel> levels;
    std::size_t carried, too_many;
    std::vector<std::size_t> next;
  };
  for (const Case& c : {Case{{}, 0, 9, {4}},
                        {{{4, 1, 1}}, 0, 9, {4}},
                        {{{4, 1, 0}}, 0, 9, {2}},
                        {{{4, 2, 2}}, 0, 9, {6}},
                        {{{4, 2, 2}, {6, 1, 0}}, 0, 9, {5}},
                        {{{4, 2, 2}, {6, 1, 0}, {5, 1, 0}}, 0, 9, {5, 4}},
                        {{{4, 2, 2}, {6, 1, 0}, {5, 2, 0}}, 0, 5, {4}},
                        {{{4, 36, 36}, {5, 2, 0}}, 4, 5, {}},
                        {{{8, 36, 36}}, 8, 9, {}},
                        {{{4, 2, 0}, {2, 2, 0}, {1, 2, 0}}, 0, 1, {}},
                        {{{5, 20, 19}, {4, 9, 9}}, 0, 9, {7}},
                        {{{3, 36, 36}, {2, 2, 1}, {4, 2, 0}}, 3, 4, {}},
                        {{{5, 36, 36}, {2, 2, 0}}, 1, 2, {}}}) {
    const UavAnswer answer = answer_by_uavs(question, c.levels);
    EXPECT_EQ(answer.carried, c.carried);
    EXPECT_EQ(answer.too_many, c.too_many);
    EXPECT_EQ(answer.next, c.next);
    EXPECT_EQ(answer.is_decided(), c.next.empty());
  }
}

// Boards that carry some number of UAVs of up to 8 with a share of 0.98, and more with 0.3.
TEST(ByUavs, FindsTheNumberOfMostBoardsWithFewFlights) {
  const UavQuestion question{.most = 8};
  int right = 0;
  std::size_t flown = 0;
  constexpr int kBoards = 200;
  for (int board = 0; board < kBoards; ++board) {
    const std::size_t carried = static_cast<std::size_t>(board) % 9;
    std::vector<UavLevel> levels;
    UavAnswer answer = answer_by_uavs(question, levels);
    for (std::uint64_t flight = 0; flight < 300 && !answer.is_decided(); ++flight, ++flown) {
      auto at = std::ranges::find(levels, answer.next.front(), &UavLevel::uavs);
      if (at == levels.end()) at = levels.insert(levels.end(), {answer.next.front()});
      ++at->flights;
      const double share = at->uavs <= carried ? 0.98 : 0.3;
      if (KeyedRandom({static_cast<std::uint64_t>(board), 0, flight}).uniform() < share)
        ++at->reached;
      answer = answer_by_uavs(question, levels);
    }
    if (answer.is_decided() && answer.carried == carried) ++right;
  }
  EXPECT_GE(right, kBoards * 95 / 100);
  EXPECT_LE(flown, std::size_t{kBoards} * 75);
}

}  // namespace
}  // namespace tether::sizing

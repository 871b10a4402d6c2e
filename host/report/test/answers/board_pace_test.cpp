#include "answers/board_pace.h"

#include <optional>
#include <vector>

#include <gtest/gtest.h>

namespace tether::report {
namespace {

TEST(BoardPace, OverFlightsHasMeansAndTheirSpread) {
  const auto flight = [](double nano_s, double pi_s, std::optional<double> alone) {
    return std::vector<BoardPace>{
        {.board = "nano", .uavs = {"uav1"}, .median_s = nano_s, .p95_s = 2.0 * nano_s},
        {.board = "pi", .uavs = {"uav2"}, .median_s = pi_s, .p95_s = 2.0 * pi_s, .alone = alone}};
  };
  const std::vector<std::vector<BoardPace>> flights = {
      flight(0.1, 0.2, 0.5), {}, flight(0.3, 0.2, 0.7), flight(0.2, 0.5, 0.6)};
  const auto boards = over_flights(flights);
  ASSERT_EQ(boards.size(), 2u);
  EXPECT_EQ(boards[0].flights, 3u);
  EXPECT_EQ(boards[0].slowest_in, 1u);
  EXPECT_EQ(boards[1].slowest_in, 2u);
  EXPECT_NEAR(boards[0].median_s, 0.2, 1e-12);
  EXPECT_EQ(boards[0].p95_range_s, std::pair(0.2, 0.6));
  EXPECT_EQ(boards[0].alone, std::nullopt);
  EXPECT_NEAR(*boards[1].alone, 0.6, 1e-12);
  EXPECT_EQ(boards[1].alone_range, std::pair(0.5, 0.7));
  EXPECT_EQ(slowest_of(boards).board, "pi");
  EXPECT_TRUE(over_flights({}).empty());
}

}  // namespace
}  // namespace tether::report
